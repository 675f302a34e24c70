// 8.14.2 Trajectories: prediction of their temporal values.
#pragma once

#include <cstdint>

#include "common/codec/bits/int_math.h"
#include "common/codec/components/series_predictor.h"
#include "common/codec/components/track_order.h"
#include "common/codec/kinds/skinned/skinned_gof.h"

namespace rlpc {

inline constexpr int kTemporalWeightFractionBits = 6;

// 8.14.2 PredictTrajectory( series, place ): predicts a coordinate from the values series(f) at
// earlier places of the track.
template <class Series>
std::int64_t predict_trajectory(const Trajectory& trajectory, const Series& series,
                                const TrackPlace& at) {
  if (at.neighbours > 0) {
    return round2(sum_of_neighbours(series, at), at.neighbours == 2 ? 1 : 4);
  }
  const std::uint32_t before = at.frame / at.stride;
  int order = trajectory.temporal_predictor;
  if (order > kMaxPredictorOrder) {
    const auto count = static_cast<std::uint32_t>(order - kMaxPredictorOrder);
    if (before >= count) {
      std::int64_t sum = 0;
      for (std::uint32_t k = 0; k < count; ++k) {
        sum += trajectory.temporal_weight[k] * series(at.frame - (k + 1) * at.stride);
      }
      return round2(sum, kTemporalWeightFractionBits);
    }
    order = 1;
  }
  return predict_series([&](std::uint32_t i) { return series(i * at.stride); }, before, order);
}

}  // namespace rlpc
