// 8.15 Adaptive weights of one vertex, a transcript of the pseudo-code with the widths that the
// text states; for tests.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "common/codec/bits/int_math.h"

namespace rlpc {

struct FilterOfText {
  using List = std::vector<std::int64_t>;

  static constexpr std::int64_t kMaxWeight = (1 << 19) - 1;

  // Ranges of 8.15, or of 8.19 if is_of_frames.
  bool is_of_frames = false;
  std::size_t ring = 0;
  std::size_t neighbours = 0;  // 8.19: ring and others
  List weight;
  std::vector<List> spread;

  // shift: 12, or 9 in later component groups.
  void start_spread(int shift) {
    spread.assign(weight.size(), List(weight.size(), 0));
    for (std::size_t i = 0; i < weight.size(); ++i) spread[i][i] = random_walk(i) << shift;
  }
  void start_spread_of_frames() {
    start_spread(21);
    for (std::size_t i = 0; i < weight.size(); ++i) {
      spread[i][i] = std::min<std::int64_t>(1 << 26, spread[i][i]);
    }
  }

  static std::int64_t max_magnitude(const List& list) {
    std::int64_t max = 1;
    for (const std::int64_t x : list) max = std::max(max, std::abs(x));
    return max;
  }
  std::int64_t random_walk(std::size_t i) const {
    if (!is_of_frames) return i < ring ? 256 : 64;
    if (i < ring) return 64;
    return i < neighbours ? 16 : 128;
  }

  std::int64_t predict_offset(const List& offsets) const {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i) sum += weight[i] * offsets[i];
    return round2(sum, 16);
  }

  // variance: of the residual, for 8.19.
  void adapt(const List& offsets, std::int64_t error, std::int64_t variance = 0) {
    const std::size_t n = offsets.size();
    const int bits = is_of_frames ? 11 : 7;
    const std::int64_t max_error = is_of_frames ? 16384 : 1024;
    const std::int64_t max_spread = is_of_frames ? 1 << 26 : (1 << 22) - 1;
    const int shift =
        std::max(floor_log2(static_cast<std::uint64_t>(max_magnitude(offsets))) - 9, 0);
    error = clip3(-max_error, max_error, round2(error, shift));
    List shifted(n);
    for (std::size_t i = 0; i < n; ++i) shifted[i] = round2(offsets[i], shift);
    List gain(n);
    std::int64_t noise = 1 << 21;
    if (is_of_frames) {
      noise = clip3(1 << 14, std::int64_t{1} << 41, shift_by(variance, 2 * shift - 1));
    }
    std::int64_t scale = noise;
    for (std::size_t i = 0; i < n; ++i) {
      std::int64_t sum = 0;
      for (std::size_t j = 0; j < n; ++j) sum += spread[i][j] * shifted[j];
      ASSERT_LT(std::abs(sum), std::int64_t{1} << (30 + bits));
      gain[i] = round2(sum, bits);
      scale += gain[i] * shifted[i];
    }
    ASSERT_LT(max_magnitude(gain), std::int64_t{1} << 30);
    scale = std::max(scale, noise);
    scale += (scale - noise) >> 10;
    ASSERT_LT(scale, std::int64_t{1} << 46);
    const int narrow =
        std::max(floor_log2(static_cast<std::uint64_t>(max_magnitude(gain))) - 13, 0);
    const int exponent = floor_log2(static_cast<std::uint64_t>(scale)) - 14;
    const std::int64_t inverse = (1 << 29) / (scale >> exponent);
    ASSERT_LE(inverse, 1 << 15);
    List change(n);
    for (std::size_t i = 0; i < n; ++i) {
      gain[i] = round2(gain[i], narrow);
      change[i] = round2(gain[i] * inverse, 15);
    }
    ASSERT_LE(max_magnitude(gain), 1 << 14);
    ASSERT_LE(max_magnitude(change), 1 << 14);
    const int weighting = std::clamp(exponent - narrow - 2, 0, 31);
    const int spreading = std::clamp(15 - bits + exponent - 2 * narrow, 1, 31);
    for (std::size_t i = 0; i < n; ++i) {
      weight[i] =
          clip3(-kMaxWeight, kMaxWeight, weight[i] + round2(change[i] * error, weighting));
      for (std::size_t j = 0; j <= i; ++j) {
        const std::int64_t product = change[i] * gain[j] + change[j] * gain[i];
        spread[i][j] = spread[j][i] =
            clip3(-max_spread, max_spread, spread[i][j] - round2(product, spreading));
      }
      spread[i][i] = clip3(1, max_spread, spread[i][i] + random_walk(i));
    }
  }
};

}  // namespace rlpc
