// Integer functions of clause 5: the only place that rounds, clips or takes roots.
// Everything is exact in int64; each function states its proven range.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>

namespace rlpc {

// 5.3 Round2(x, n): floor((x + 2^(n-1)) / 2^n); n == 0 returns x. |x| < 2^62, 0 <= n < 62.
constexpr std::int64_t round2(std::int64_t x, int n) {
  assert(n >= 0 && n < 62);
  return n == 0 ? x : (x + (std::int64_t{1} << (n - 1))) >> n;
}
static_assert(round2(5, 1) == 3 && round2(-5, 1) == -2);  // ties go up

// 8.11.1 ShiftBy(x, shift): round2 if shift > 0, otherwise x * 2^-shift, which must be below
// 2^62.
constexpr std::int64_t shift_by(std::int64_t x, int shift) {
  return shift > 0 ? round2(x, shift) : x * (std::int64_t{1} << -shift);
}

// 5.3 DivRound(x, n): floor(x / n + 1/2). |x| < 2^61, 0 < n < 2^61.
constexpr std::int64_t div_round(std::int64_t x, std::int64_t n) {
  assert(n > 0);
  const std::int64_t a = 2 * x + n;
  const std::int64_t q = a / (2 * n);
  return q - static_cast<std::int64_t>(a % (2 * n) < 0);
}
static_assert(div_round(5, 2) == 3 && div_round(-5, 2) == -2 && div_round(-7, 3) == -2);

// 5.3 Clip3(lo, hi, x)
constexpr std::int64_t clip3(std::int64_t lo, std::int64_t hi, std::int64_t x) {
  return std::clamp(x, lo, hi);
}

// 5.3 ClipSigned(bits, x): x clipped to the range of signed numbers with that many bits.
constexpr std::int32_t clip_signed(int bits, std::int64_t x) {
  assert(bits >= 1 && bits <= 32);
  const std::int64_t half = std::int64_t{1} << (bits - 1);
  return static_cast<std::int32_t>(clip3(-half, half - 1, x));
}

// 5.3 FloorLog2(x): position of the highest one bit. x > 0.
constexpr int floor_log2(std::uint64_t x) {
  assert(x > 0);
  return 63 - std::countl_zero(x);
}

// 5.3 CeilLog2(x): bits needed to distinguish x values. x > 0.
constexpr int ceil_log2(std::uint64_t x) { return x <= 1 ? 0 : floor_log2(x - 1) + 1; }

// 5.4 ISqrt(x): floor of the square root. 0 <= x < 2^62.
constexpr std::int64_t isqrt(std::int64_t x) {
  assert(x >= 0);
  std::int64_t root = 0;
  for (int bit = 30; bit >= 0; --bit) {
    const std::int64_t trial = root + (std::int64_t{1} << bit);
    if (trial * trial <= x) root = trial;
  }
  return root;
}
static_assert(isqrt(0) == 0 && isqrt(15) == 3 && isqrt(16) == 4);

// Vector of clause 5.4: differences and cross products of positions, |component| < 2^56.
using Vec3l = std::array<std::int64_t, 3>;

// 5.4 Normalize3(v): the unit vector along v with 30 fractional bits; zero for the zero vector.
constexpr Vec3l normalize3(Vec3l v) {
  std::int64_t largest = 0;
  for (const std::int64_t c : v) largest = std::max(largest, c < 0 ? -c : c);
  if (largest == 0) return {0, 0, 0};
  const int shift = 29 - floor_log2(static_cast<std::uint64_t>(largest));
  std::int64_t norm2 = 0;
  for (std::int64_t& c : v) {
    c = shift >= 0 ? c * (std::int64_t{1} << shift) : round2(c, -shift);
    norm2 += c * c;  // |c| <= 2^30, so norm2 < 2^62
  }
  const std::int64_t norm = isqrt(norm2);
  for (std::int64_t& c : v) c = div_round(c * (std::int64_t{1} << 30), norm);
  return v;
}

}  // namespace rlpc
