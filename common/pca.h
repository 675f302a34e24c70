// Shared PCA model (clause 8.5): sums of products of temporal and spatial factors, exact in
// integers. Components whose declared widths allow it go through 16 x 16 -> 32-bit products;
// sums are exact, so that every order of summation and every vector width gives the same
// result.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/int_math.h"

namespace rlpc {

// Spatial factors narrower than this are shifted up to it, so that temporal factors can be
// short.
inline constexpr int kSpatialNormBits = 13;

// Table 8-1: 2^(i / 8) with 15 fractional bits.
inline constexpr std::array<std::int32_t, 8> kScaleMantissa{32768, 35734, 38968, 42495,
                                                            46341, 50535, 55109, 60097};

// 8.5.2 Temporal factor of a temporal value; |value| < 2^23, result within temporal_bits.
constexpr std::int32_t scale_temporal(std::int32_t value, int scale_idx, int temporal_bits) {
  const std::int64_t product =
      std::int64_t{value} * kScaleMantissa[static_cast<std::size_t>(scale_idx % 8)];
  return clip_signed(temporal_bits, round2(product, 19 - scale_idx / 8));
}

// Width of a spatial factor after normalisation.
constexpr int spatial_factor_bits(int spatial_bits) {
  return spatial_bits > kSpatialNormBits ? spatial_bits : kSpatialNormBits;
}

// Factors of one cluster, arranged for the sum over its components.
class FactorSet {
 public:
  // num_values: coded coordinates of the cluster (3 x vertices); num_frames: of the GOF.
  FactorSet(std::size_t num_values, std::size_t num_frames)
      : num_values_(num_values), num_frames_(num_frames) {}

  // temporal [num_frames] scaled; spatial [num_values] before normalisation. The widths are the
  // declared ones: spatial within spatial_bits (at most 24), temporal within temporal_bits
  // (26).
  void add(std::span<const std::int32_t> temporal, int temporal_bits,
           std::span<const std::int32_t> spatial, int spatial_bits);

  // 8.5.3: sums[i] = sum over the components of temporal(frame) * spatial(i); below 2^58.
  void sum(std::size_t frame, std::span<std::int64_t> sums) const;

 private:
  // Narrow components whose products together stay within 31 bits.
  struct NarrowGroup {
    std::vector<std::int16_t> temporal;  // [component][num_frames]
    std::vector<std::int16_t> spatial;   // [component][num_values]
    std::size_t size = 0;
    std::int64_t bound = 0;
  };
  struct Wide {
    std::vector<std::int32_t> temporal;
    std::vector<std::int32_t> spatial;
  };

  void sum_narrow(const NarrowGroup& group, std::size_t frame,
                  std::span<std::int32_t> sums) const;

  std::size_t num_values_;
  std::size_t num_frames_;
  std::vector<NarrowGroup> narrow_;
  std::vector<Wide> wide_;
};

}  // namespace rlpc
