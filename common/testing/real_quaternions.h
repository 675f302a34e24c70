// Quaternions in floating point, an independent reference for 8.12, and random ones.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "common/codec/kinds/skinned/recon/quaternion.h"

namespace rlpc {

inline constexpr double kQuaternionOne = 1 << kQuaternionFractionBits;
inline constexpr std::int64_t kOneI = std::int64_t{1} << kQuaternionFractionBits;
using Real4 = std::array<double, 4>;
using Real3 = std::array<double, 3>;

inline double length_of(const Quaternion& q) {
  double sum = 0.0;
  for (const std::int64_t x : q) sum += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(sum);
}

inline Real4 unit(const Quaternion& q) {
  const double n = length_of(q);
  Real4 u{};
  for (std::size_t c = 0; c < 4; ++c) u[c] = static_cast<double>(q[c]) / n;
  return u;
}

// The quaternion product in floating point, in vector form, as an independent reference.
inline Real4 times(const Real4& p, const Real4& q) {
  const auto cross = [](const Real4& a, const Real4& b, std::size_t c) {
    const std::size_t i = 1 + c % 3;
    const std::size_t k = 1 + (c + 1) % 3;
    return a[i] * b[k] - a[k] * b[i];
  };
  Real4 r{p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]};
  for (std::size_t c = 1; c < 4; ++c) r[c] = p[0] * q[c] + q[0] * p[c] + cross(p, q, c);
  return r;
}

// q (0, v) q*
inline Real3 turned(const Real4& q, const Real3& v) {
  const Real4 r = times(times(q, {0.0, v[0], v[1], v[2]}), {q[0], -q[1], -q[2], -q[3]});
  return {r[1], r[2], r[3]};
}

// Random quaternions and numbers.
class RandomRotations {
 public:
  explicit RandomRotations(unsigned seed) : engine_(seed) {}
  std::int64_t magnitude_below(std::int64_t n) {
    const auto x = static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(n));
    return engine_() % 2 == 0 ? x : -x;
  }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  Quaternion quaternion(int bits) {
    Quaternion q{};
    for (std::int64_t& x : q) x = magnitude_below(std::int64_t{1} << bits);
    return q;
  }
  Quaternion rotation() { return normalize_quaternion(quaternion(40)); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace rlpc
