// Range decoder (clause 9.3). Its twin is common/codec/bits/range_encoder.h.
//
// State: `range` and `code`, 32 bits each, code < range; 2^24 <= range after each bin. Bytes
// are shifted in, most significant first. A section of n bytes ends exactly when n - 1 bytes
// have been shifted in after the first; past its end the decoder reads zeros, at most three.
#pragma once

#include <cassert>
#include <cstdint>
#include <span>

#include "common/codec/bits/bit_model.h"

namespace rlpc {

class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::uint8_t> section) : section_(section) {
    for (int i = 0; i < 4; ++i) code_ = (code_ << 8) | next_byte();
    if (code_ >= range_) {
      starts_legally_ = false;
      code_ = range_ - 1;
    }
  }

  // 9.3.3 ae(model)
  bool bin(BitModel& model) {
    const auto bound =
        static_cast<std::uint32_t>((std::uint64_t{range_} * model.probability()) >> 16);
    const bool one = code_ < bound;
    if (one) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    model.update(one);
    renormalize();
    return one;
  }

  // 9.3.4 bypass(n): n equally likely bits, the most significant first; 0 <= n <= 32.
  std::uint32_t bypass(int n) {
    std::uint32_t value = 0;
    for (int i = 0; i < n; ++i) {
      const std::uint32_t half = range_ >> 1;
      const bool one = code_ >= half;
      if (one) code_ -= half;
      range_ = one ? range_ - half : half;
      value = (value << 1) | static_cast<std::uint32_t>(one);
      renormalize();
    }
    return value;
  }

  // Returns false if the first four bytes are all 255, which no encoder writes (R-RNG-02).
  bool starts_legally() const { return starts_legally_; }
  // Returns whether the section held exactly the bytes that were needed (R-RNG-01).
  bool at_exact_end() const { return taken_ == section_.size() + 3; }
  // Returns whether bytes past the end were needed; the caller may stop decoding.
  bool overrun() const { return taken_ > section_.size() + 3; }
  // Returns the bits consumed so far, rounded up; for traces and error positions.
  std::uint64_t bits_spent() const {
    return std::uint64_t{taken_} * 8 - 1 - static_cast<std::uint64_t>(floor_log2(range_));
  }

 private:
  std::uint32_t next_byte() {
    const std::uint32_t byte = taken_ < section_.size() ? section_[taken_] : 0;
    ++taken_;
    return byte;
  }
  void renormalize() {
    while (range_ < (std::uint32_t{1} << 24)) {
      range_ <<= 8;
      code_ = (code_ << 8) | next_byte();
    }
    assert(code_ < range_);
  }

  std::span<const std::uint8_t> section_;
  std::size_t taken_ = 0;
  std::uint32_t range_ = 0xFFFFFFFF;
  std::uint32_t code_ = 0;
  bool starts_legally_ = true;
};

}  // namespace rlpc
