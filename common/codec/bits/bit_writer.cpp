#include "common/codec/bits/bit_writer.h"

#include <cassert>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/memory/owned.h"

namespace rlpc {

void BitWriter::u(int n, std::uint32_t value) {
  assert(n >= 1 && n <= 32 && (n == 32 || value < (std::uint64_t{1} << n)));
  for (int i = n - 1; i >= 0; --i) {
    if (free_bits_ == 0) {
      bytes_.push_back(0);
      free_bits_ = 8;
    }
    --free_bits_;
    bytes_.back() =
        static_cast<std::uint8_t>(bytes_.back() | (((value >> i) & 1U) << free_bits_));
  }
}

void BitWriter::ue(std::uint32_t value) {
  assert(value != 0xFFFFFFFF);
  const std::uint32_t code = value + 1;
  const int zeros = floor_log2(code);
  if (zeros > 0) u(zeros, 0);
  u(zeros + 1, code);
}

void BitWriter::se(std::int32_t value) {
  const std::int64_t v = value;
  ue(static_cast<std::uint32_t>(v > 0 ? 2 * v - 1 : -2 * v));
}

void BitWriter::byte_alignment() { free_bits_ = 0; }

void BitWriter::append(const Vector<std::uint8_t>& bytes) {
  assert(free_bits_ == 0);
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

Vector<std::uint8_t> BitWriter::take() {
  assert(free_bits_ == 0);
  return std::move(bytes_);
}

}  // namespace rlpc
