// Residuals of a frame, stored compactly: most are small, and frames are many.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "common/memory/owned.h"

namespace rlpc {

// List of residuals, one byte each and twelve more for a large one. All are 0 at first.
class CompactResiduals {
 public:
  CompactResiduals() = default;
  explicit CompactResiduals(std::size_t size) : small_(size, 0) {}

  std::size_t size() const { return small_.size(); }
  // Sets a residual, each at most once and in any order. sort() must follow before reading.
  void set(std::size_t i, std::int32_t value) {
    if (value > kLarge && value <= kMaxSmall) {
      small_[i] = static_cast<std::int8_t>(value);
    } else {
      small_[i] = kLarge;
      large_.emplace_back(i, value);
    }
  }
  void sort() { std::sort(large_.begin(), large_.end()); }
  std::int32_t operator[](std::size_t i) const {
    if (small_[i] != kLarge) return small_[i];
    return std::lower_bound(large_.begin(), large_.end(),
                            std::pair(i, std::numeric_limits<std::int32_t>::min()))
        ->second;
  }
  std::size_t num_large() const { return large_.size(); }

  bool operator==(const CompactResiduals&) const = default;

 private:
  static constexpr std::int8_t kLarge = std::numeric_limits<std::int8_t>::min();
  static constexpr std::int8_t kMaxSmall = std::numeric_limits<std::int8_t>::max();

  Vector<std::int8_t> small_;
  Vector<std::pair<std::size_t, std::int32_t>> large_;  // index and value, by index
};

}  // namespace rlpc
