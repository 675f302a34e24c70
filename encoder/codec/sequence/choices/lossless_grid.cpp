#include "encoder/codec/sequence/choices/lossless_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/meshes/mesh_text.h"

namespace rlpc {
namespace {

// Returns the largest n for which the number, which must not be 0, is a multiple of 2^n.
int lowest_bit(float x) {
  constexpr int kMantissaBits = 23;        // fixed: IEEE 754
  constexpr int kDenormalExponent = -149;  // fixed: IEEE 754
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t fraction = bits & ((1U << kMantissaBits) - 1);
  const int exponent = static_cast<int>((bits >> kMantissaBits) & 0xFF);
  if (exponent == 0) return kDenormalExponent + std::countr_zero(fraction);
  return kDenormalExponent + exponent - 1 + std::countr_zero(fraction | (1U << kMantissaBits));
}

struct FinestCoordinate {
  int log2_step = kMaxGridLog2Step + 1;
  std::uint32_t frame = 0;
  std::size_t index = 0;  // 3 * vertex + axis
  float value = 0;
};

InputResult<FinestCoordinate> find_finest(FrameSource& source) {
  FinestCoordinate finest;
  std::vector<float> xyz(3 * std::size_t{source.num_vertices()});
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    if (auto error = source.read_frame(f, xyz)) return *error;
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      if (xyz[i] == 0) continue;
      const int n = lowest_bit(xyz[i]);
      if (n < finest.log2_step) finest = {n, f, i, xyz[i]};
    }
  }
  return finest;
}

// Returns none if the grid cannot represent the box within the limits of the format.
std::optional<GridChoice> grid_of_step(const Extent& extent, int log2_step) {
  const double per_step = exact_exp2(-log2_step);
  const auto position = [&](double x) { return std::floor(x * per_step + 0.5); };
  double widest = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    widest = std::max(widest, position(extent.max[c]) - position(extent.min[c]));
  }
  GridChoice choice;
  choice.grid.log2_step = log2_step;
  choice.position_bits = kMinPositionBits;
  while (choice.position_bits <= kMaxPositionBits &&
         exact_exp2(choice.position_bits) <= widest) {
    ++choice.position_bits;
  }
  if (choice.position_bits > kMaxPositionBits) return std::nullopt;
  for (std::size_t c = 0; c < 3; ++c) {
    const double origin = position(extent.min[c]) + exact_exp2(choice.position_bits - 1);
    if (std::abs(origin) > kMaxGridOrigin) return std::nullopt;
    choice.grid.origin[c] = static_cast<std::int32_t>(origin);
  }
  return choice;
}

}  // namespace

InputResult<GridChoice> grid_of_source(FrameSource& source, const Extent& extent) {
  const auto finest = find_finest(source);
  if (!finest) return finest.error();
  const int log2_step = std::min(finest->log2_step, kMaxGridLog2Step);
  if (const auto choice = grid_of_step(extent, log2_step)) return *choice;
  return InputError{
      source.file_of(finest->frame) + ": frame " + std::to_string(finest->frame) +
      " (from 0), vertex " + std::to_string(finest->index / 3) + ": " +
      "xyz"[finest->index % 3] + " is " + shortest_text(finest->value) +
      ", a multiple of no more than 2^" + std::to_string(log2_step) +
      ": the coordinates have no common grid of 24 bits or fewer. Use 'target = lossless, "
      "target_value = BITS', which rounds them to a grid of that many bits, up to 24"};
}

GridChoice grid_of_bits(const Extent& extent, int position_bits) {
  for (int n = kMinGridLog2Step; n < kMaxGridLog2Step; ++n) {
    auto choice = grid_of_step(extent, n);
    if (choice && choice->position_bits <= position_bits) return *choice;
  }
  return *grid_of_step(extent, kMaxGridLog2Step);  // coordinates are within 2^100
}

}  // namespace rlpc
