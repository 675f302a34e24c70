// Input parsing of the fuzz targets, and checks that are active in every build.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

namespace rlpc {

// Consumes an input from its front; past the end, numbers are zero and byte strings empty.
class FuzzInput {
 public:
  FuzzInput(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  // Reads a little-endian number of 1 to 4 bytes.
  std::uint32_t number(std::size_t bytes) {
    std::uint32_t value = 0;
    const auto digits = take(bytes);
    for (std::size_t i = 0; i < digits.size(); ++i) value |= std::uint32_t{digits[i]} << 8 * i;
    return value;
  }
  std::span<const std::uint8_t> take(std::size_t bytes) {
    const auto taken = rest_.first(std::min(bytes, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  std::span<const std::uint8_t> rest() const { return rest_; }

 private:
  std::span<const std::uint8_t> rest_;
};

// Checks a property that must hold for every input; unlike assert, also in release builds.
inline void fuzz_check(bool holds) {
  if (!holds) std::abort();
}

}  // namespace rlpc
