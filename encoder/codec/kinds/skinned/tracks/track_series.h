// Values of tracks in closed loop, for ResidualSearch.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/skinned/recon/bones.h"
#include "common/codec/kinds/skinned/recon/trajectory_prediction.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {

// The temporal values of a trajectory with a given predictor.
class TrajectorySeries {
 public:
  static constexpr bool kCoupled = false;  // each coordinate has values of its own
  using Value = std::int64_t;
  struct Predicted {
    std::array<double, 3> wanted{};  // residual, in steps
    std::int64_t prediction = 0;
  };

  // wanted: [num_frames], in steps. The references must outlive the series.
  TrajectorySeries(std::span<const std::array<double, 3>> wanted, const Trajectory& trajectory)
      : wanted_(wanted), trajectory_(trajectory) {}

  template <class Known>
  Predicted predict(const Known& known, const TrackPlace& at, std::size_t c) const {
    Predicted predicted;
    predicted.prediction = predict_trajectory(trajectory_, known, at);
    predicted.wanted[c] = wanted_[at.frame][c] - static_cast<double>(predicted.prediction);
    return predicted;
  }
  double follow(const Predicted& /*predicted*/, Vec3i& /*residual*/, std::size_t /*c*/) const {
    return 0.0;  // the coordinates are predicted independently
  }
  Value value(const Predicted& predicted, const Vec3i& residual, const TrackPlace& /*at*/,
              std::size_t c) const {
    return clip_signed(kTemporalIndexBits, predicted.prediction + residual[c]);
  }
  static bool are_alike(Value a, Value b) { return a == b; }
  // Returns the value nearest to the wanted one.
  Value ideal(std::uint32_t f, std::size_t c) const { return round_to_int(wanted_[f][c]); }

 private:
  std::span<const std::array<double, 3>> wanted_;
  const Trajectory& trajectory_;
};

// How a track of offsets is coded: those of the origin of a bone, or what its stretches differ.
struct OffsetHeader {
  std::uint32_t step_idx = 0;
  int order = 0;
  int between = 0;
};

class OffsetSeries {
 public:
  static constexpr bool kCoupled = false;
  using Value = std::int64_t;
  using Predicted = TrajectorySeries::Predicted;

  // wanted: [num_frames], in the unit of the offsets.
  OffsetSeries(std::span<const std::array<double, 3>> wanted, const OffsetHeader& header)
      : wanted_(wanted), order_(header.order), step_(step_of(header.step_idx)) {}

  template <class Known>
  Predicted predict(const Known& known, const TrackPlace& at, std::size_t c) const {
    Predicted predicted;
    predicted.prediction = predict_offset(known, at, order_);
    predicted.wanted[c] = (wanted_[at.frame][c] - static_cast<double>(predicted.prediction)) /
                          static_cast<double>(step_);
    return predicted;
  }
  double follow(const Predicted& /*predicted*/, Vec3i& /*residual*/, std::size_t /*c*/) const {
    return 0.0;
  }
  Value value(const Predicted& predicted, const Vec3i& residual, const TrackPlace& /*at*/,
              std::size_t c) const {
    return offset_from(predicted.prediction, residual[c], step_);
  }
  static bool are_alike(Value a, Value b) { return a == b; }
  Value ideal(std::uint32_t f, std::size_t c) const { return round_to_int(wanted_[f][c]); }

 private:
  std::span<const std::array<double, 3>> wanted_;
  int order_;
  std::int64_t step_;
};

using QuaternionD = std::array<double, 4>;

QuaternionD product(const QuaternionD& p, const QuaternionD& q);
QuaternionD inverse(const Quaternion& q);

// The rotations of a bone relative to its parent. The coordinates of a residual are coupled: a
// change of one turns the axes of those that follow.
class RotationSeries {
 public:
  static constexpr bool kCoupled = true;
  using Value = Quaternion;
  struct Predicted {
    std::array<double, 3> wanted{};
    Quaternion prediction = kNoRotation;
  };

  // wanted: [num_frames], of unit length.
  RotationSeries(std::span<const QuaternionD> wanted, const Bone& bone)
      : wanted_(wanted), order_(bone.rotation_order), step_(step_of(bone.rotation_step_idx)) {}

  template <class Known>
  Predicted predict(const Known& known, const TrackPlace& at, std::size_t /*c*/) const {
    Predicted predicted;
    predicted.prediction = predict_rotation(known, at, order_);
    predicted.wanted = wanted_residual(predicted.prediction, at.frame);
    return predicted;
  }
  double follow(const Predicted& predicted, Vec3i& residual, std::size_t c) const;
  Value value(const Predicted& predicted, const Vec3i& residual, const TrackPlace& /*at*/,
              std::size_t /*c*/) const {
    return rotation_from(predicted.prediction, residual, step_);
  }
  bool are_alike(const Value& a, const Value& b) const;
  Value ideal(std::uint32_t f, std::size_t c) const;

 private:
  std::array<double, 3> wanted_residual(const Quaternion& prediction, std::uint32_t f) const;

  std::span<const QuaternionD> wanted_;
  int order_;
  std::int64_t step_;
};

}  // namespace rlpc
