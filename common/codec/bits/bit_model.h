// Adaptive probability of one binary decision (clause 9.4).
#pragma once

#include <array>
#include <cstdint>

#include "common/codec/bits/int_math.h"

namespace rlpc {

// Mean of a fast and a slow estimate of P(bin == 1), both in 1/65536. Each starts as a plain
// average of the bins, until its adaptation rate is reached.
class BitModel {
 public:
  // Returns P(bin == 1) in 1/65536, from 71 to 65465, which bounds the cost of a bin.
  std::uint32_t probability() const { return (fast_ + slow_) >> 1; }

  void update(bool bin) {
    const int fast_shift = kShift[count_] < kFastShift ? kShift[count_] : kFastShift;
    const int slow_shift = kShift[count_];
    if (bin) {
      fast_ += (65536 - fast_) >> fast_shift;
      slow_ += (65536 - slow_) >> slow_shift;
    } else {
      fast_ -= fast_ >> fast_shift;
      slow_ -= slow_ >> slow_shift;
    }
    if (count_ < kMaxCount) ++count_;
  }

 private:
  static constexpr int kFastShift = 4;
  static constexpr int kSlowShift = 7;
  static constexpr std::uint32_t kMaxCount = 126;
  // 1 + FloorLog2(count + 1), at most kSlowShift.
  static constexpr auto kShift = [] {
    std::array<std::uint8_t, kMaxCount + 1> shift{};
    for (std::uint32_t n = 0; n <= kMaxCount; ++n) {
      const int s = 1 + floor_log2(n + 1);
      shift[n] = static_cast<std::uint8_t>(s < kSlowShift ? s : kSlowShift);
    }
    return shift;
  }();

  std::uint32_t fast_ = 32768;
  std::uint32_t slow_ = 32768;
  std::uint32_t count_ = 0;
};

}  // namespace rlpc
