// Mathematical functions with the same result on every compiler and machine: they use only the
// four operations and sqrt, which round correctly. Encoder decisions use these in place of
// libm.
#pragma once

#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace rlpc {

// Returns log2(x) for finite x > 0; absolute error below 1e-9.
inline double det_log2(double x) {
  assert(x > 0.0);
  const auto bits = std::bit_cast<std::uint64_t>(x);
  auto exponent = static_cast<int>((bits >> 52) & 0x7FF) - 1023;
  if (exponent == -1023) return det_log2(x * 0x1p60) - 60.0;  // subnormal
  auto mantissa = std::bit_cast<double>((bits & 0xFFFFFFFFFFFFFULL) | 0x3FF0000000000000ULL);
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++exponent;
  }
  // log2(m) = 2 / ln 2 * artanh((m - 1) / (m + 1)), |argument| < 0.172
  const double t = (mantissa - 1.0) / (mantissa + 1.0);
  const double t2 = t * t;
  double sum = 0.0;
  for (int k = 13; k >= 1; k -= 2) sum = sum * t2 + 1.0 / k;
  return exponent + 2.8853900817779268 * t * sum;
}

// Returns 2^n for |n| < 1000.
inline double exact_exp2(int n) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(n + 1023) << 52);
}

// Returns 2^x for |x| < 900; relative error below 1e-12.
inline double det_exp2(double x) {
  const auto whole = static_cast<int>(x < 0.0 ? x - 0.5 : x + 0.5);
  const double t = (x - whole) * 0.69314718055994531;
  double sum = 1.0;
  for (int k = 13; k >= 1; --k) sum = 1.0 + sum * t / k;
  return sum * exact_exp2(whole);
}

// Returns sin(x) for |x| <= pi / 2; absolute error below 1e-15.
inline double det_sin(double x) {
  assert(-1.5708 < x && x < 1.5708);
  double sum = 1.0;
  for (int k = 20; k >= 2; k -= 2) sum = 1.0 - sum * x * x / (k * (k + 1));
  return x * sum;
}

// Returns atan(x) for 0 <= x <= 1; absolute error below 1e-15.
inline double det_atan(double x) {
  assert(0.0 <= x && x <= 1.0);
  // Halve the angle twice; it is then at most pi / 16.
  for (int i = 0; i < 2; ++i) x /= 1.0 + std::sqrt(1.0 + x * x);
  double sum = 0.0;
  for (int k = 21; k >= 1; k -= 2) sum = 1.0 / k - sum * x * x;
  return 4.0 * x * sum;
}

// Returns the nearest integer, ties away from zero; |x| < 2^52.
inline std::int64_t round_to_int(double x) {
  return static_cast<std::int64_t>(x < 0.0 ? x - 0.5 : x + 0.5);
}

}  // namespace rlpc
