#include "common/codec/kernels/kernels.h"

#include <algorithm>

#include "common/codec/bits/fixed_point.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/kernels/kernels_avx2.h"
#include "common/codec/kernels/kernels_wasm.h"

namespace rlpc {
namespace {

void sum_products(const FactorPairs& factors, std::size_t first_row, std::size_t num_rows,
                  std::int32_t* sums) {
  std::fill_n(sums, num_rows * kTileValues, 0);
  for (std::size_t k = 0; k < factors.num_pairs; ++k) {
    const std::int16_t* const s = factors.spatial + 2 * kTileValues * k;
    const std::int16_t* t = factors.temporal + 2 * (factors.temporal_rows * k + first_row);
    for (std::size_t r = 0; r < num_rows; ++r, t += 2) {
      std::int32_t* const row = sums + kTileValues * r;
      for (std::size_t i = 0; i < kTileValues; ++i) {
        row[i] += std::int32_t{t[0]} * s[2 * i] + std::int32_t{t[1]} * s[2 * i + 1];
      }
    }
  }
}

void add_weighted(const std::int32_t* values, std::int32_t weight, std::size_t n,
                  std::int64_t* sums) {
  for (std::size_t i = 0; i < n; ++i) sums[i] += std::int64_t{weight} * values[i];
}

void weighted_places(const BoneArms& arms, const std::array<std::int32_t, 3>& axis,
                     std::int32_t origin, std::int64_t* places) {
  for (std::size_t i = 0; i < arms.size; ++i) {
    std::int64_t sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += std::int64_t{axis[k]} * arms.arm[k][i];
    places[i] = arms.weight[i] * (round2(sum, kQuaternionFractionBits) + origin);
  }
}

void positions(const std::int64_t* places, const std::int64_t* displacements,
               const PositionWidths& widths, std::int32_t* positions) {
  for (std::size_t i = 0; i < kTileValues; ++i) {
    const std::int64_t place =
        round2(places[i], widths.weight_bits) +
        clip_signed(kLocalBits, round2(displacements[i], widths.fraction_bits));
    positions[i] = clip_signed(widths.position_bits, round2(place, kPointFractionBits));
  }
}

constexpr Kernels kPlain{sum_products,   add_weighted, weighted_places, positions,
                         predict_offset, adapt,        adapt_to_frame};

}  // namespace

std::span<const Kernels> kernels() {
#ifdef RLPC_HAVE_AVX2_KERNELS
  static const std::array<Kernels, 2> kLoops{kPlain, kKernelsAvx2};
  static const std::size_t kCount = __builtin_cpu_supports("avx2") != 0 ? 2 : 1;
  return std::span(kLoops).first(kCount);
#elif defined(RLPC_HAVE_WASM_KERNELS)
  static constexpr std::array<Kernels, 2> kLoops{
      kPlain,
      {sum_products_wasm, add_weighted, weighted_places, positions, predict_offset, adapt,
       adapt_to_frame}};
  return kLoops;
#else
  static constexpr std::array<Kernels, 1> kLoops{kPlain};
  return kLoops;
#endif
}

}  // namespace rlpc
