// Models and contexts of the range-coder section of a GOF (clause 9.6). The parser and the
// writer drive them in the same way; they are reset in each GOF.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/bits/bit_model.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/bits/residual_models.h"
#include "common/codec/components/track_models.h"
#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/cluster/cluster_map.h"

namespace rlpc {

struct ClusterModels : ClusterMapModels {
  BitModel lcf_flag;
  std::array<BitModel, kMaxPredictorOrder> temporal_predictor;
  std::array<BitModel, kMaxSpatialPredictor> spatial_predictor;
  ResidualModels header;
  ResidualModels seed;
  ResidualModels temporal;
  ResidualModels spatial;
  std::array<std::uint32_t, 4> header_mean{};  // [HeaderField]
};

// 9.6.4 Expected magnitude of a temporal residual.
class TemporalContext {
 public:
  // frame_mean [num_gof_frames]: running mean over the previous components, per frame; updated.
  TemporalContext(std::span<std::uint32_t> frame_mean, const Component& component)
      : frame_mean_(frame_mean) {
    const int bits = component.temporal_bits - component.scale_idx / 8 + 4;
    const int fewer = component.temporal_predictor == 0 ? 3 : 5;
    mean_.reset(std::uint32_t{256} << std::clamp(bits - fewer, 0, 20));
  }
  std::uint32_t expected(std::uint32_t f) const {
    return (mean_.fast + mean_.slow + 2 * frame_mean_[f]) >> 6;
  }
  void update(std::uint32_t f, std::int32_t residual) {
    const std::uint32_t magnitude = magnitude_of(residual);
    mean_.update(magnitude);
    frame_mean_[f] = update_mean(frame_mean_[f], magnitude, 1);
  }

 private:
  std::span<std::uint32_t> frame_mean_;
  RunningMagnitude mean_;
};

// 9.6.5 Expected magnitude of a spatial residual.
class SpatialContext {
 public:
  explicit SpatialContext(const Component& component) {
    const int fewer = component.spatial_predictor == SpatialPredictor::kNone ? 3 : 5;
    for (RunningMagnitude& m : mean_) {
      m.reset(std::uint32_t{256} << std::clamp(component.spatial_bits - fewer, 0, 20));
    }
  }
  std::uint32_t expected(std::size_t c) const {
    const std::uint32_t here = c == 0 ? mean_[0].fast : before_;
    return (2 * mean_[c].slow + mean_[c].fast + here) >> 6;
  }
  void update(std::size_t c, std::int32_t residual) {
    mean_[c].update(magnitude_of(residual));
    before_ = clipped_magnitude(residual);
  }

 private:
  std::array<RunningMagnitude, 3> mean_;
  std::uint32_t before_ = 0;
};

}  // namespace rlpc
