// 7.11: settings of a GOF for the weights of prediction along the mesh (8.11).
#pragma once

#include <cstdint>

namespace rlpc {

inline constexpr int kMaxLayerStep = 16;  // sixteenths of the step of a factor or of a frame

struct WeightSettings {
  int damping_log2 = 0;                    // 0: plain weights
  int outer_weight = 0;                    // 1/16
  int outer_scale = 0;                     // 1/16
  std::uint32_t num_adaptive_factors = 0;  // trajectories that adapt the weights (8.15)
  bool operator==(const WeightSettings&) const = default;
};

}  // namespace rlpc
