// Counts the bits of arithmetic-coded bins without writing them, to compare codings.
#pragma once

#include <array>
#include <cstdint>

#include "common/codec/bits/bit_model.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {

// Replaces a RangeEncoder; models adapt in the same way.
class BitCost {
 public:
  void bin(BitModel& model, bool one) {
    const std::uint32_t p = model.probability();
    cost_ += kCost[(one ? p : 65536 - p) >> kTableShift];
    model.update(one);
  }
  void bypass(int n, std::uint32_t /*value*/) {
    cost_ += static_cast<std::uint64_t>(n) << kOne;
  }

  double bits() const {
    return static_cast<double>(cost_) / static_cast<double>(std::uint64_t{1} << kOne);
  }

 private:
  static constexpr int kOne = 16;  // fraction bits of a cost
  static constexpr int kTableShift = 4;
  static inline const auto kCost = [] {
    std::array<std::uint32_t, (65536 >> kTableShift) + 1> cost{};
    for (std::size_t i = 0; i < cost.size(); ++i) {
      const double p =
          (static_cast<double>(i) + 0.5) / static_cast<double>(65536 >> kTableShift);
      cost[i] = static_cast<std::uint32_t>(
          round_to_int((p < 1.0 ? -det_log2(p) : 0.0) * static_cast<double>(1 << kOne)));
    }
    return cost;
  }();

  std::uint64_t cost_ = 0;

  friend class BitEstimate;
};

// Like BitCost, but does not adapt the models, for candidates that may be rejected.
class BitEstimate {
 public:
  void bin(const BitModel& model, bool one) {
    const std::uint32_t p = model.probability();
    cost_ += BitCost::kCost[(one ? p : 65536 - p) >> BitCost::kTableShift];
  }
  void bypass(int n, std::uint32_t /*value*/) {
    cost_ += static_cast<std::uint64_t>(n) << BitCost::kOne;
  }
  double bits() const {
    return static_cast<double>(cost_) / static_cast<double>(std::uint64_t{1} << BitCost::kOne);
  }

 private:
  std::uint64_t cost_ = 0;
};

}  // namespace rlpc
