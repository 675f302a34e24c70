#include "encoder/codec/sequence/choices/grid_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "common/codec/bits/int_math.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

constexpr double kMaxCoordinate = 0x1p100;  // fixed: larger ones overflow squares
constexpr int kDefaultPositionBits = 20;    // fixed: a grid that is never too coarse
constexpr double kStepsPerError = 32.0;  // fixed: rounding adds 1e-4 of the least squared error
constexpr double kMargin =
    1.02;  // fixed: room, so that decoded positions are almost never clipped

// Returns the smallest n with 2^n >= x; x > 0.
int ceil_exponent(double x) {
  int n = static_cast<int>(std::floor(det_log2(x))) - 1;
  while (exact_exp2(n) < x) ++n;
  return n;
}

}  // namespace

InputResult<Extent> measure_extent(FrameSource& source) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent extent{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}, 0.0};
  const std::size_t n = source.num_vertices();
  std::vector<float> xyz(3 * n);
  double spread = 0.0;
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    if (auto error = source.read_frame(f, xyz)) return *error;
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (std::size_t v = 0; v < n; ++v) {
        const double x = xyz[3 * v + c];
        sum += x;
        extent.min[c] = std::min(extent.min[c], x);
        extent.max[c] = std::max(extent.max[c], x);
      }
      const double mean = sum / static_cast<double>(n);
      for (std::size_t v = 0; v < n; ++v) {
        spread += (xyz[3 * v + c] - mean) * (xyz[3 * v + c] - mean);
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if (std::max(-extent.min[c], extent.max[c]) <= kMaxCoordinate) continue;
      return InputError{
          source.file_of(f) + ": frame " + std::to_string(f) +
          " (from 0) has coordinates beyond 2^100 (about 1.3e30); scale the animation down"};
    }
  }
  extent.rms_spread = std::sqrt(spread / (3.0 * static_cast<double>(n) * source.num_frames()));
  return extent;
}

double finest_error(const Target& target, double rms_spread) {
  if (target.kind == Target::kKg) return rms_spread * target.likely_kg() / 100.0;
  return target.kind == Target::kMaxError ? target.value : 0.0;
}

GridChoice choose_grid(const Extent& extent, double finest_error) {
  double half = 0.0;     // largest half width of the bounding box
  double largest = 0.0;  // largest coordinate of its centre
  std::array<double, 3> centre{};
  for (std::size_t c = 0; c < 3; ++c) {
    half = std::max(half, 0.5 * extent.max[c] - 0.5 * extent.min[c]);
    centre[c] = 0.5 * extent.min[c] + 0.5 * extent.max[c];
    largest = std::max(largest, std::abs(centre[c]));
  }
  // The margin also covers rounding of the origin.
  const double reach = half * kMargin;
  int bits = kDefaultPositionBits;
  if (finest_error > 0.0 && reach > 0.0) {
    constexpr double kMaxSteps = 0x1p40;  // fixed: beyond all grids
    const double steps =
        std::clamp(2.0 * reach * kStepsPerError / finest_error, 1.0, kMaxSteps);
    bits = std::clamp(ceil_exponent(steps), kDefaultPositionBits, kMaxPositionBits);
  }
  int log2_step = kMinGridLog2Step;
  if (reach > 0.0) log2_step = std::max(log2_step, ceil_exponent(reach) - (bits - 1));
  if (largest > 0.0) log2_step = std::max(log2_step, ceil_exponent(largest / kMaxGridOrigin));
  GridChoice choice;
  choice.position_bits = bits;
  choice.grid.log2_step = log2_step;
  for (std::size_t c = 0; c < 3; ++c) {
    choice.grid.origin[c] =
        static_cast<std::int32_t>(round_to_int(centre[c] * exact_exp2(-log2_step)));
  }
  return choice;
}

}  // namespace rlpc
