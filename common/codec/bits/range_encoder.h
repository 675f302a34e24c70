// Range encoder, the inverse of clause 9.3.
//
// `low` has 33 bits, the top one a carry into bytes already written. A byte that a carry could
// still change is held back, together with the 0xFF bytes that would propagate it.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "common/codec/bits/bit_model.h"
#include "common/memory/owned.h"

namespace rlpc {

class RangeEncoder {
 public:
  void bin(BitModel& model, bool one) {
    const auto bound =
        static_cast<std::uint32_t>((std::uint64_t{range_} * model.probability()) >> 16);
    if (one) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    model.update(one);
    renormalize();
  }

  void bypass(int n, std::uint32_t value) {
    for (int i = n - 1; i >= 0; --i) {
      const std::uint32_t half = range_ >> 1;
      const bool one = ((value >> i) & 1U) != 0;
      if (one) low_ += half;
      range_ = one ? range_ - half : half;
      renormalize();
    }
  }

  // Returns the number of bytes so far, without those that finish() adds.
  std::size_t size() const { return bytes_.size() + pending_ff_ + (has_cache_ ? 1 : 0); }

  // Ends the section: one more byte suffices, as range >= 2^24. The encoder cannot be used
  // afterwards.
  Vector<std::uint8_t> finish() {
    low_ = (low_ + 0xFFFFFF) & ~std::uint64_t{0xFFFFFF};
    shift_low();
    // The held-back bytes can no longer change.
    shift_low();
    return std::move(bytes_);
  }

 private:
  void renormalize() {
    while (range_ < (std::uint32_t{1} << 24)) {
      range_ <<= 8;
      shift_low();
    }
  }
  void shift_low() {
    if (low_ < 0xFF000000U || low_ > 0xFFFFFFFFU) {
      const bool carry = low_ > 0xFFFFFFFFU;
      if (has_cache_) bytes_.push_back(static_cast<std::uint8_t>(cache_ + (carry ? 1 : 0)));
      assert(has_cache_ || !carry);
      for (; pending_ff_ > 0; --pending_ff_) bytes_.push_back(carry ? 0x00 : 0xFF);
      cache_ = static_cast<std::uint8_t>(low_ >> 24);
      has_cache_ = true;
    } else {
      ++pending_ff_;
    }
    low_ = (low_ & 0x00FFFFFFU) << 8;
  }

  Vector<std::uint8_t> bytes_;
  std::uint64_t low_ = 0;
  std::uint64_t pending_ff_ = 0;
  std::uint32_t range_ = 0xFFFFFFFF;
  std::uint8_t cache_ = 0;
  bool has_cache_ = false;
};

}  // namespace rlpc
