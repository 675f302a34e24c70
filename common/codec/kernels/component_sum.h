// PCA model (clause 8.5): sums of products of temporal and spatial factors, exact in integers.
// All products are 16 x 16 -> 32 bits; sums are exact, so that every order of summation and
// every vector width yields the same result.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "common/codec/bits/int_math.h"
#include "common/codec/kernels/kernels.h"
#include "common/memory/owned.h"

namespace rlpc {

// Width to which narrower spatial factors are normalised, so that temporal factors can be
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

// Returns the width of a spatial factor after normalisation.
constexpr int spatial_factor_bits(int spatial_bits) {
  return spatial_bits > kSpatialNormBits ? spatial_bits : kSpatialNormBits;
}

// Limb of a factor, at most 16 bits: floor(value / 2^shift), or the remainder.
struct FactorLimb {
  int shift;
  int size_log2;  // |limb| <= 2^size_log2
  bool is_low;

  std::int32_t of(std::int32_t value) const;
};

// Spatial factors of components, laid out for summation; any number of sums can share them.
// Factors of more than 16 bits are split into two limbs of at most 14 bits, so that all
// products are 16 x 16 bits.
class SpatialFactors {
 public:
  // num_values: spatial values per component.
  explicit SpatialFactors(std::size_t num_values) : num_values_(num_values) {}

  // Adds the factor of the next component. spatial: before normalisation, within spatial_bits
  // (at most 24); value i is spatial[i * stride].
  void add(std::span<const std::int32_t> spatial, int spatial_bits, std::size_t stride = 1);

  // Returns the factors of a tile, normalised: [kTileValues][num_components]; 0 past the last
  // value.
  Vector<std::int32_t> tile(std::size_t tile) const;

  std::size_t num_values() const { return num_values_; }
  std::size_t num_components() const { return num_components_; }
  std::size_t num_tiles() const { return (num_values_ + kTileValues - 1) / kTileValues; }

 private:
  friend class ComponentSum;

  // Limbs of equal shift, in pairs.
  struct Limbs {
    struct Place {
      std::size_t component;
      int size_log2;
    };
    Vector<Place> places;
    Vector<Vector<std::int16_t>> tiles;  // [tile][pairs][kTileValues][2]
  };

  std::size_t num_values_;
  std::size_t num_components_ = 0;
  std::array<Limbs, 2> limbs_;  // limbs of shift 0, and high limbs
};

// Temporal factor of a component, [num_rows], scaled, within `bits` (at most 26). 0 bits: the
// component does not occur.
struct TemporalFactor {
  Vector<std::int32_t> values;
  int bits = 0;
};

class ComponentSum {
 public:
  // num_rows: temporal values per component, one per frame or per coordinate of a frame.
  // temporal: factors of the first components of `spatial`; the others do not occur. Read
  // during the call.
  ComponentSum(std::shared_ptr<const SpatialFactors> spatial,
               std::span<const TemporalFactor> temporal, std::size_t num_rows,
               const Kernels& loops = kernels().back());

  std::size_t num_values() const { return spatial_->num_values(); }
  // 8.5.3: adds the sum over the components of temporal(row) * spatial(i), at most 2^58, for
  // several rows and the values of a tile, from kTileValues * tile on, to sums
  // [num_rows][kTileValues]; adds nothing past the last value.
  void add_tile(std::size_t tile, std::size_t first_row, std::size_t num_rows,
                std::span<std::int64_t> sums) const;

 private:
  // Consecutive pairs whose products have a sum within 31 bits, scaled by 2^shift.
  struct Segment {
    std::size_t list;  // index in SpatialFactors::limbs_
    int shift;
    std::size_t first_pair;
    std::size_t num_pairs;
    Vector<std::int16_t> temporal;  // [pairs][num_rows][2]
  };
  class SegmentMaker;

  std::shared_ptr<const SpatialFactors> spatial_;
  std::size_t num_rows_;
  Kernels loops_;
  Vector<Segment> segments_;
};

}  // namespace rlpc
