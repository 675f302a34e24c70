// The PCA model (clause 8.5): sums of products of temporal and spatial factors, exact in
// integers. All go through 16 x 16 -> 32-bit products; sums are exact, so that every order of
// summation and every vector width gives the same result.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/int_math.h"
#include "common/kernels/kernels.h"

namespace rlpc {

// Narrower spatial factors are normalised to this width, so that temporal factors can be short.
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

// Factors of all components, laid out for summation. Factors of more than 16 bits are split
// into two limbs of at most 14 bits, so that all products are of 16 x 16 bits.
class ComponentSum {
 public:
  // num_values: spatial values per component. num_rows: temporal values per component, one per
  // frame or per coordinate of a frame.
  ComponentSum(std::size_t num_values, std::size_t num_rows,
               const Kernels& loops = kernels().back())
      : num_values_(num_values), num_rows_(num_rows), loops_(loops) {}

  // Adds a component. temporal [num_rows]: scaled, within temporal_bits (at most 26). spatial:
  // before normalisation, within spatial_bits (at most 24); value i is spatial[i * stride].
  void add(std::span<const std::int32_t> temporal, int temporal_bits,
           std::span<const std::int32_t> spatial, int spatial_bits, std::size_t stride = 1);

  // 8.5.3: sums[i] = sum over the components of temporal(row) * spatial(i); at most 2^58.
  void sum(std::size_t row, std::span<std::int64_t> sums) const;
  // The same for several rows and the values of a tile, kTileValues * tile and after;
  // sums [num_rows][kTileValues], zero where there are fewer values.
  void sum_tile(std::size_t tile, std::size_t first_row, std::size_t num_rows,
                std::span<std::int64_t> sums) const;

 private:
  // Components whose products have a sum within 31 bits, scaled by 2^shift.
  struct Group {
    int shift = 0;
    std::int64_t bound = 0;
    std::size_t size = 0;
    std::vector<std::int16_t> temporal;              // [pairs][num_rows][2]
    std::vector<std::vector<std::int16_t>> spatial;  // [tiles][pairs][kTileValues][2]
  };
  // One 16-bit limb of a factor: floor(value / 2^shift), or the remainder.
  struct Limb {
    int shift;
    int size_log2;  // |limb| <= 2^size_log2
    bool is_low;
    std::int32_t of(std::int32_t value) const;
  };

  static std::vector<Limb> limbs_of(int bits);
  Group& group_for(int shift, std::int64_t bound);
  std::size_t num_tiles() const { return (num_values_ + kTileValues - 1) / kTileValues; }

  std::size_t num_values_;
  std::size_t num_rows_;
  Kernels loops_;
  std::vector<Group> groups_;
};

}  // namespace rlpc
