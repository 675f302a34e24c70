#include "common/codec/kernels/kernels_avx2.h"

#ifdef RLPC_HAVE_AVX2_KERNELS

#include <immintrin.h>

#include <cstring>

#include "common/codec/bits/fixed_point.h"
#include "common/codec/kernels/weight_filter_avx2.h"

#define RLPC_AVX2 [[gnu::target("avx2")]]

namespace rlpc {
namespace {

RLPC_AVX2 __m256i load(const void* p) {
  return _mm256_loadu_si256(static_cast<const __m256i*>(p));
}
RLPC_AVX2 void store(void* p, __m256i x) { _mm256_storeu_si256(static_cast<__m256i*>(p), x); }
// Loads four 32-bit numbers, extended to 64 bits.
RLPC_AVX2 __m256i load_widened(const std::int32_t* p) {
  return _mm256_cvtepi32_epi64(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)));
}

// Computes round2 of 64-bit numbers below 2^62 in magnitude. They are made positive first,
// because AVX2 lacks a 64-bit arithmetic shift.
class Round2 {
 public:
  RLPC_AVX2 explicit Round2(int n)
      : shift_(_mm_cvtsi32_si128(n)),
        before_(_mm256_set1_epi64x(kOffset + (n > 0 ? std::int64_t{1} << (n - 1) : 0))),
        after_(_mm256_set1_epi64x(kOffset >> n)) {}
  RLPC_AVX2 __m256i operator()(__m256i x) const {
    return _mm256_sub_epi64(_mm256_srl_epi64(_mm256_add_epi64(x, before_), shift_), after_);
  }

 private:
  static constexpr std::int64_t kOffset = std::int64_t{1} << 62;
  __m128i shift_;
  __m256i before_;
  __m256i after_;
};

// Sums for kRows rows and two vectors of values, held in registers.
template <std::size_t kRows>
RLPC_AVX2 void sum_block(const FactorPairs& factors, std::size_t first_row, std::size_t i,
                         std::int32_t* sums) {
  __m256i sum[kRows][2];
  for (auto& row : sum) row[0] = row[1] = _mm256_setzero_si256();
  const std::int16_t* s = factors.spatial + 2 * i;
  const std::int16_t* t = factors.temporal + 2 * first_row;
  for (std::size_t k = 0; k < factors.num_pairs; ++k) {
    const __m256i s0 = load(s);
    const __m256i s1 = load(s + 16);
    for (std::size_t r = 0; r < kRows; ++r) {
      std::int32_t pair = 0;
      std::memcpy(&pair, t + 2 * r, sizeof pair);
      const __m256i w = _mm256_set1_epi32(pair);
      sum[r][0] = _mm256_add_epi32(sum[r][0], _mm256_madd_epi16(w, s0));
      sum[r][1] = _mm256_add_epi32(sum[r][1], _mm256_madd_epi16(w, s1));
    }
    s += 2 * kTileValues;
    t += 2 * factors.temporal_rows;
  }
  for (std::size_t r = 0; r < kRows; ++r) {
    store(sums + kTileValues * r + i, sum[r][0]);
    store(sums + kTileValues * r + i + 8, sum[r][1]);
  }
}

RLPC_AVX2 void sum_products(const FactorPairs& factors, std::size_t first_row,
                            std::size_t num_rows, std::int32_t* sums) {
  std::size_t r = 0;
  for (; r + 3 <= num_rows; r += 3) {
    for (std::size_t i = 0; i < kTileValues; i += 16) {
      sum_block<3>(factors, first_row + r, i, sums + kTileValues * r);
    }
  }
  for (; r < num_rows; ++r) {
    for (std::size_t i = 0; i < kTileValues; i += 16) {
      sum_block<1>(factors, first_row + r, i, sums + kTileValues * r);
    }
  }
}

RLPC_AVX2 void add_weighted(const std::int32_t* values, std::int32_t weight, std::size_t n,
                            std::int64_t* sums) {
  const __m256i w = _mm256_set1_epi64x(weight);
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) {
    const __m256i product = _mm256_mul_epi32(w, load_widened(values + i));
    store(sums + i, _mm256_add_epi64(load(sums + i), product));
  }
  for (; i < n; ++i) sums[i] += std::int64_t{weight} * values[i];
}

// The lists of arms and weights are padded by at least three numbers.
RLPC_AVX2 void weighted_places(const BoneArms& arms, const std::array<std::int32_t, 3>& axis,
                               std::int32_t origin, std::int64_t* places) {
  const __m256i x = _mm256_set1_epi64x(axis[0]);
  const __m256i y = _mm256_set1_epi64x(axis[1]);
  const __m256i z = _mm256_set1_epi64x(axis[2]);
  const __m256i o = _mm256_set1_epi64x(origin);
  const __m256i half = _mm256_set1_epi64x(std::int64_t{1} << (kQuaternionFractionBits - 1));
  for (std::size_t i = 0; i < arms.size; i += 4) {
    const __m256i product_x = _mm256_mul_epi32(x, load_widened(arms.arm[0] + i));
    const __m256i product_y = _mm256_mul_epi32(y, load_widened(arms.arm[1] + i));
    const __m256i product_z = _mm256_mul_epi32(z, load_widened(arms.arm[2] + i));
    const __m256i sum = _mm256_add_epi64(_mm256_add_epi64(product_x, product_y),
                                         _mm256_add_epi64(product_z, half));
    // The rotated arm has 32 bits, all that the products read.
    const __m256i turned = _mm256_srli_epi64(sum, kQuaternionFractionBits);
    const __m256i weight = load_widened(arms.weight + i);
    store(places + i,
          _mm256_add_epi64(_mm256_mul_epi32(weight, turned), _mm256_mul_epi32(weight, o)));
  }
}

RLPC_AVX2 void positions(const std::int64_t* places, const std::int64_t* displacements,
                         const PositionWidths& widths, std::int32_t* positions) {
  const Round2 round_places(widths.weight_bits);
  const Round2 round_sums(widths.fraction_bits);
  const Round2 round_point(kPointFractionBits);
  const __m256i max = _mm256_set1_epi64x((std::int64_t{1} << (kLocalBits - 1)) - 1);
  const __m256i min = _mm256_set1_epi64x(-(std::int64_t{1} << (kLocalBits - 1)));
  const __m128i max_position = _mm_set1_epi32((1 << (widths.position_bits - 1)) - 1);
  const __m128i min_position = _mm_set1_epi32(-(1 << (widths.position_bits - 1)));
  const __m256i low_halves = _mm256_setr_epi32(0, 2, 4, 6, 0, 2, 4, 6);
  for (std::size_t i = 0; i < kTileValues; i += 4) {
    __m256i moved = round_sums(load(displacements + i));
    moved = _mm256_blendv_epi8(moved, max, _mm256_cmpgt_epi64(moved, max));
    moved = _mm256_blendv_epi8(moved, min, _mm256_cmpgt_epi64(min, moved));
    const __m256i place = _mm256_add_epi64(round_places(load(places + i)), moved);
    // 8.14.3: below 2^34 and 2^30, so that 32 bits are enough after rounding.
    const __m128i narrow =
        _mm256_castsi256_si128(_mm256_permutevar8x32_epi32(round_point(place), low_halves));
    const __m128i clipped = _mm_max_epi32(_mm_min_epi32(narrow, max_position), min_position);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(positions + i), clipped);
  }
}

}  // namespace

const Kernels kKernelsAvx2{sum_products,        add_weighted, weighted_places,    positions,
                           predict_offset_avx2, adapt_avx2,   adapt_to_frame_avx2};

}  // namespace rlpc

#endif
