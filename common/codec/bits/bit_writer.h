// Writes the fixed-length and Exp-Golomb codes of clause 9.2, most significant bit first.
#pragma once

#include <cstdint>

#include "common/memory/owned.h"

namespace rlpc {

class BitWriter {
 public:
  void u(int n, std::uint32_t value);  // value < 2^n, 1 <= n <= 32
  void flag(bool value) { u(1, value ? 1 : 0); }
  void ue(std::uint32_t value);  // value <= 2^32 - 2
  void se(std::int32_t value);
  void byte_alignment();
  // append() and take() require a byte-aligned position.
  void append(const Vector<std::uint8_t>& bytes);
  Vector<std::uint8_t> take();

 private:
  Vector<std::uint8_t> bytes_;
  int free_bits_ = 0;  // free bits of the last byte
};

}  // namespace rlpc
