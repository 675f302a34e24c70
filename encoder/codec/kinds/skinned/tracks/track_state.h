// State that codings of a track pass on, and the cost by which they are compared.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/codec/bits/bit_model.h"
#include "common/codec/components/track_models.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {

// Models and means shared by the tracks of one type (9.8.1, 9.8.2): the state before the next
// track.
struct TrackState {
  explicit TrackState(std::uint32_t num_frames) : mean(num_frames, 0) {}
  TrackModels models;
  std::array<BitModel, kMaxBetween> between;  // for rotation_between and the like
  std::vector<std::uint32_t> mean;
};

struct TrackCost {
  double bits = 0.0;
  double error = 0.0;  // sum of squared errors of all values, in squared steps
};

inline double lagrangian_cost(const TrackCost& cost) {
  return cost.error + kLambda * cost.bits;
}

}  // namespace rlpc
