// Prediction of rest positions (8.18): along hinges, or from a counterpart.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/codec/bits/int_math.h"
#include "common/codec/mesh/rest_order.h"

namespace rlpc {

// 8.18.5 Axes: normal to hinges, along, and across; unit vectors with 30 fractional bits.
using RestAxes = std::array<Vec3l, 3>;

class RestPrediction {
 public:
  // values: [num_vertices][3]; the values of a vertex are read when later ones are predicted.
  RestPrediction(const RestOrder& order, std::span<const std::int32_t> values, int bits)
      : order_(order), values_(values), bits_(bits) {}

  struct Weights {
    int edge = 0;
    int ring = 0;
  };
  // 8.18.3 Prediction along hinges: PredictRest( v )
  Vec3l predict(std::uint32_t v, const Weights& weights) const;
  // 8.18.5 Axes: RestAxes( hinges )
  RestAxes axes(std::span<const Hinge> hinges) const;
  // 8.18.6 Reconstruction: MeanParallelogram( hinges )
  Vec3l base(std::span<const Hinge> hinges) const;
  // 8.18.6 Reconstruction: PredictFromCounterpart( v, hinges, axes ). own[i] corresponds to
  // other[i]; own_axes: axes of own.
  Vec3l from_counterpart(std::span<const Hinge> own, const RestAxes& own_axes,
                         std::span<const Hinge> other, std::uint32_t counterpart,
                         bool mirrored) const;

  static RestAxes world() {
    constexpr std::int64_t kOne = std::int64_t{1} << 30;
    return {Vec3l{kOne, 0, 0}, Vec3l{0, kOne, 0}, Vec3l{0, 0, kOne}};
  }
  // 8.18.6 Reconstruction: TurnedTo( axes, x )
  static Vec3l turned(const RestAxes& axes, const Vec3l& x) {
    Vec3l sum{};
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] = round2(axes[0][c] * x[0] + axes[1][c] * x[1] + axes[2][c] * x[2], 30);
    }
    return sum;
  }

 private:
  std::int64_t at(std::uint32_t v, std::size_t c) const {
    return values_[std::size_t{v} * 3 + c];
  }

  const RestOrder& order_;
  std::span<const std::int32_t> values_;
  int bits_;
};

}  // namespace rlpc
