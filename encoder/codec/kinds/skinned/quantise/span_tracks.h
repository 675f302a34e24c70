// Codes the temporal values of a trajectory in the GOFs of a span (inverse of 8.14.2).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/mesh.h"
#include "encoder/codec/kinds/skinned/quantise/skinned_analysis.h"

namespace rlpc {

// Wanted values up to this limit fit their width, however they are rounded.
inline constexpr double kMaxTemporal = 1 << (kTemporalIndexBits - 2);  // fixed: format

// Returns 2^(eighths / 8) as the format defines it.
double power_of_eighths(int eighths);

class SpanTracks {
 public:
  // may_drop: trajectories need not occur in a GOF. Keeps references to GOFs and settings.
  SpanTracks(std::span<const SkinnedGof> gofs, const SkinnedSettings& settings, bool may_drop);

  // A trajectory in all GOFs.
  struct Coded {
    std::vector<Trajectory> gof_trajectories;
    TrackCost cost;
    std::vector<TrackState> after;
  };
  // Codes a trajectory without changing the states. wanted [frame]; unit: quantiser step, in
  // the unit of the values.
  Coded code(std::span<const std::array<double, 3>> wanted, double unit) const;
  // Keeps the trajectory: the next one follows it.
  void follow(Coded& coded) { states_ = std::move(coded.after); }
  // Returns the values of a trajectory as decoded, in steps, in all frames; 0 where it does not
  // occur.
  std::vector<Vec3i> indices(const Coded& coded) const;
  std::size_t num_frames() const { return num_frames_; }

 private:
  std::span<const SkinnedGof> gofs_;
  const SkinnedSettings& settings_;
  bool may_drop_;
  std::size_t num_frames_ = 0;
  std::vector<TrackState> states_;  // [GOF]
};

// Returns the width in bits of a signed number of this magnitude.
int signed_width(std::int64_t magnitude);
// Sets scale and width of a trajectory in a GOF. Returns false if a value exceeds the maximum
// width.
bool set_scale(int scale_idx, std::span<const Vec3i> indices, Trajectory& trajectory);

}  // namespace rlpc
