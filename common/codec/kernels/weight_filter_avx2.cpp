// Twin of the plain loops of weight_filter.cpp: eight neighbours at a time.
#include "common/codec/kernels/weight_filter_avx2.h"

#ifdef RLPC_HAVE_AVX2_KERNELS

#include <immintrin.h>

#include <algorithm>
#include <array>

#include "common/codec/bits/int_math.h"

#define RLPC_AVX2 [[gnu::target("avx2")]]

namespace rlpc {
namespace {

RLPC_AVX2 __m256i load(const std::int32_t* p) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
RLPC_AVX2 void store(std::int32_t* p, __m256i x) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), x);
}

// Returns the sum of the products of 32-bit numbers, in four 64-bit numbers.
RLPC_AVX2 __m256i product_sums(__m256i a, __m256i b) {
  const __m256i even = _mm256_mul_epi32(a, b);
  const __m256i odd = _mm256_mul_epi32(_mm256_srli_epi64(a, 32), _mm256_srli_epi64(b, 32));
  return _mm256_add_epi64(even, odd);
}
RLPC_AVX2 std::int64_t sum_of(__m256i x) {
  const __m128i half = _mm_add_epi64(_mm256_castsi256_si128(x), _mm256_extracti128_si256(x, 1));
  return _mm_extract_epi64(half, 0) + _mm_extract_epi64(half, 1);
}

template <std::size_t kVectors>
struct Vectors {
  __m256i list[kVectors];

  __m256i& operator[](std::size_t k) { return list[k]; }
  const __m256i& operator[](std::size_t k) const { return list[k]; }
};

// Returns a number with the floor_log2 of the largest magnitude: the union of all bits, at
// least 1.
template <std::size_t kVectors>
RLPC_AVX2 std::uint32_t bits_of(const Vectors<kVectors>& x) {
  __m256i bits = _mm256_abs_epi32(x[0]);
  for (std::size_t k = 1; k < kVectors; ++k) {
    bits = _mm256_or_si256(bits, _mm256_abs_epi32(x[k]));
  }
  const __m128i half =
      _mm_or_si128(_mm256_castsi256_si128(bits), _mm256_extracti128_si256(bits, 1));
  const auto all = static_cast<std::uint64_t>(_mm_extract_epi64(half, 0)) |
                   static_cast<std::uint64_t>(_mm_extract_epi64(half, 1));
  return static_cast<std::uint32_t>(all) | static_cast<std::uint32_t>(all >> 32) | 1U;
}

// Computes round2 of 32-bit numbers below 2^31 - 2^(n - 1).
RLPC_AVX2 __m256i rounded(__m256i x, int n) {
  const __m256i half = _mm256_set1_epi32(static_cast<std::int32_t>((1U << n) >> 1));
  return _mm256_sra_epi32(_mm256_add_epi32(x, half), _mm_cvtsi32_si128(n));
}
RLPC_AVX2 __m256i clipped(__m256i x, std::int32_t max) {
  return _mm256_max_epi32(_mm256_min_epi32(x, _mm256_set1_epi32(max)), _mm256_set1_epi32(-max));
}

template <std::size_t kVectors>
RLPC_AVX2 std::int64_t predict_vectors(const FilterState& filter, const std::int32_t* offsets) {
  __m256i sums = _mm256_setzero_si256();
  for (std::size_t k = 0; k < kVectors; ++k) {
    const std::size_t i = kFilterVector * k;
    sums = _mm256_add_epi64(sums, product_sums(load(&filter.weight[i]), load(offsets + i)));
  }
  return round2(sum_of(sums), kAdaptiveFractionBits);
}

// NOLINTBEGIN(cppcoreguidelines-pro-type-member-init): vectors are filled before they are read.
template <std::size_t kVectors, const FilterForm& kForm, class Noise>
RLPC_AVX2 void adapt_vectors(const FilterState& filter, const std::int32_t* offsets,
                             std::int64_t error, const Noise& noise) {
  constexpr std::size_t kStride = kFilterVector * kVectors;
  const std::size_t n = filter.size;
  Vectors<kVectors> offset;
  for (std::size_t k = 0; k < kVectors; ++k) offset[k] = load(offsets + kFilterVector * k);
  const int shift = std::max(floor_log2(bits_of(offset)) - kOffsetLog2, 0);
  const auto e = static_cast<std::int32_t>(
      std::clamp<std::int64_t>(round2(error, shift), -kForm.max_error, kForm.max_error));
  alignas(32) std::array<std::int32_t, kStride> numbers;
  // Sums of 64 bits; AVX2 lacks their arithmetic shift, so that they are made positive. Only
  // the lower halves of gains are used, where the bias, a multiple of 2^32, is gone.
  constexpr int kGainShift = kForm.gain_shift;
  constexpr std::int64_t kBias = std::int64_t{1} << (33 + kGainShift);
  Vectors<kVectors> even;
  Vectors<kVectors> odd;
  for (std::size_t k = 0; k < kVectors; ++k) {
    offset[k] = rounded(offset[k], shift);
    store(&numbers[kFilterVector * k], offset[k]);
    even[k] = odd[k] = _mm256_set1_epi64x(kBias + (1 << (kGainShift - 1)));
  }
  for (std::size_t i = 0; i < n; ++i) {  // spread is symmetric: by columns
    const __m256i o = _mm256_set1_epi32(numbers[i]);
    for (std::size_t k = 0; k < kVectors; ++k) {
      const __m256i s = load(&filter.spread[i * kStride + kFilterVector * k]);
      even[k] = _mm256_add_epi64(even[k], _mm256_mul_epi32(s, o));
      odd[k] = _mm256_add_epi64(odd[k], _mm256_mul_epi32(_mm256_srli_epi64(s, 32), o));
    }
  }
  Vectors<kVectors> gain;
  __m256i sums = _mm256_setzero_si256();
  for (std::size_t k = 0; k < kVectors; ++k) {
    constexpr int kOddHalves = 0xAA;
    gain[k] = _mm256_blend_epi32(_mm256_srli_epi64(even[k], kGainShift),
                                 _mm256_slli_epi64(odd[k], 32 - kGainShift), kOddHalves);
    sums = _mm256_add_epi64(sums, product_sums(gain[k], offset[k]));
  }
  const FilterShifts shifts(kForm, noise(shift), sum_of(sums), bits_of(gain));
  // Gain and change have 16 bits each, interleaved: a product of pairs is that of 8.15.3.
  Vectors<kVectors> pairs;
  const __m256i inverse = _mm256_set1_epi32(shifts.inverse);
  for (std::size_t k = 0; k < kVectors; ++k) {
    constexpr int kOddShorts = 0xAA;
    const std::size_t i = kFilterVector * k;
    gain[k] = rounded(gain[k], shifts.narrow);
    const __m256i change = rounded(_mm256_mullo_epi32(gain[k], inverse), kGainBits + 1);
    pairs[k] = _mm256_blend_epi16(gain[k], _mm256_slli_epi32(change, 16), kOddShorts);
    store(&numbers[i], _mm256_blend_epi16(change, _mm256_slli_epi32(gain[k], 16), kOddShorts));
    const __m256i product = _mm256_mullo_epi32(change, _mm256_set1_epi32(e));
    const __m256i weight =
        _mm256_add_epi32(load(&filter.weight[i]), rounded(product, shifts.weighting));
    store(&filter.weight[i], clipped(weight, kMaxAdaptiveWeight));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const __m256i pair = _mm256_set1_epi32(numbers[i]);
    std::int32_t* const row = &filter.spread[i * kStride];
    for (std::size_t k = 0; k < kVectors; ++k) {
      const __m256i product = _mm256_madd_epi16(pairs[k], pair);
      const __m256i spread =
          _mm256_sub_epi32(load(row + kFilterVector * k), rounded(product, shifts.spreading));
      store(row + kFilterVector * k, clipped(spread, kForm.max_spread));
    }
    row[i] = std::clamp(row[i] + filter.walk[i], 1, kForm.max_spread);
  }
}
// NOLINTEND(cppcoreguidelines-pro-type-member-init)

template <const FilterForm& kForm, class Noise>
RLPC_AVX2 void adapt_filter(const FilterState& filter, const std::int32_t* offsets,
                            std::int64_t error, const Noise& noise) {
  switch (filter.stride / kFilterVector) {
    case 1:
      return adapt_vectors<1, kForm>(filter, offsets, error, noise);
    case 2:
      return adapt_vectors<2, kForm>(filter, offsets, error, noise);
    case 3:
      return adapt_vectors<3, kForm>(filter, offsets, error, noise);
    default:
      return adapt_vectors<4, kForm>(filter, offsets, error, noise);
  }
}

}  // namespace

std::int64_t predict_offset_avx2(const FilterState& filter, const std::int32_t* offsets) {
  switch (filter.stride / kFilterVector) {
    case 1:
      return predict_vectors<1>(filter, offsets);
    case 2:
      return predict_vectors<2>(filter, offsets);
    case 3:
      return predict_vectors<3>(filter, offsets);
    default:
      return predict_vectors<4>(filter, offsets);
  }
}

void adapt_avx2(const FilterState& filter, const std::int32_t* offsets, std::int64_t error) {
  adapt_filter<kFactorFilter>(filter, offsets, error, [](int) { return kFactorNoise; });
}

void adapt_to_frame_avx2(const FilterState& filter, const std::int32_t* offsets,
                         std::int64_t error, std::int64_t variance) {
  adapt_filter<kFrameFilter>(filter, offsets, error,
                             [&](int shift) { return frame_noise(variance, shift); });
}

}  // namespace rlpc

#endif
