// Inner loops of reconstruction: over the vertices of a tile (8.5.3 and 8.14.3), and over the
// neighbours of a vertex (8.15). Plain loops are the definition; twins for AVX2 and WebAssembly
// SIMD are faster. All arithmetic is exact, so that both yield the same integers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/components/component_limits.h"
#include "common/codec/kernels/weight_filter.h"

namespace rlpc {

// Factors of some components, interleaved in pairs; with an odd number of components, the last
// pair is padded with zeros.
struct FactorPairs {
  const std::int16_t* temporal;  // [num_pairs][temporal_rows][2]
  std::size_t temporal_rows;
  const std::int16_t* spatial;  // [num_pairs][kTileValues][2]
  std::size_t num_pairs;        // at least 1
};

// Rest positions moved by a bone.
struct BoneArms {
  // [size]: position relative to the pivot, |arm| <= 2^29; three more numbers must be readable,
  // as for weight.
  std::array<const std::int32_t*, 3> arm;
  const std::int32_t* weight;  // [size]
  std::size_t size;
};

// Parameters of the conversion from sums to positions.
struct PositionWidths {
  int weight_bits;
  int fraction_bits;
  int position_bits;
};

struct Kernels {
  // 8.5.3: sums[r][i] = sum over the components of temporal[first_row + r] * spatial[i];
  // sums [num_rows][kTileValues]. The caller has checked that they fit.
  void (*sum_products)(const FactorPairs& factors, std::size_t first_row, std::size_t num_rows,
                       std::int32_t* sums);
  // sums[i] += values[i] * weight for i < n.
  void (*add_weighted)(const std::int32_t* values, std::int32_t weight, std::size_t n,
                       std::int64_t* sums);
  // 8.12.3 Moved point, for one coordinate: places[i] = the rest position as moved by the bone,
  // times its weight; places [kTileValues], undefined past the size. axis: that coordinate of
  // the axes of the bone. |axis| <= 2^30 + 16, |origin| <= 2^30.
  void (*weighted_places)(const BoneArms& arms, const std::array<std::int32_t, 3>& axis,
                          std::int32_t origin, std::int64_t* places);
  // 8.14.3 Positions, for one coordinate: positions [kTileValues] from sums of weighted places
  // and sums of products, [kTileValues] each.
  void (*positions)(const std::int64_t* places, const std::int64_t* displacements,
                    const PositionWidths& widths, std::int32_t* positions);
  // 8.15.2 and 8.15.3: predict_offset() and adapt() of weight_filter.h.
  std::int64_t (*predict_offset)(const FilterState& filter, const std::int32_t* offsets);
  void (*adapt)(const FilterState& filter, const std::int32_t* offsets, std::int64_t error);
  void (*adapt_to_frame)(const FilterState& filter, const std::int32_t* offsets,
                         std::int64_t error, std::int64_t variance);
};

// Returns the kernels that this machine supports: the plain loops first, the fastest last.
std::span<const Kernels> kernels();

}  // namespace rlpc
