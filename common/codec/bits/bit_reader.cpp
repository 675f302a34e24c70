#include "common/codec/bits/bit_reader.h"

#include <cassert>

namespace rlpc {

void BitReader::fail(Errc code, const char* rule, const char* element, std::uint64_t bit_pos,
                     std::uint64_t needed_bytes) {
  if (!error_) error_ = Error{code, rule, element, bit_pos, needed_bytes};
}

std::uint32_t BitReader::take(int n, const char* element, std::uint64_t at) {
  if (error_) return 0;
  if (pos_ + static_cast<std::uint64_t>(n) > std::uint64_t{bytes_.size()} * 8) {
    fail(Errc::kTruncated, "R-BIT-01", element, at);
    return 0;
  }
  std::uint32_t value = 0;
  for (int i = 0; i < n; ++i, ++pos_) {
    const unsigned bit = (bytes_[static_cast<std::size_t>(pos_ / 8)] >> (7 - pos_ % 8)) & 1U;
    value = (value << 1) | bit;
  }
  return value;
}

std::int64_t BitReader::check(std::int64_t value, const char* element, Range range,
                              const char* rule, std::uint64_t at) {
  if (error_) return range.min;
  if (trace_ != nullptr) trace_->element(element, value, at);
  if (value < range.min || value > range.max) {
    fail(Errc::kInvalid, rule, element, at);
    return range.min;
  }
  return value;
}

std::uint32_t BitReader::u(int n, const char* element, Range range, const char* rule) {
  assert(n >= 1 && n <= 32);
  const std::uint64_t at = bit_pos();
  return static_cast<std::uint32_t>(check(take(n, element, at), element, range, rule, at));
}

std::uint32_t BitReader::u(int n, const char* element) {
  return u(n, element, {0, (std::int64_t{1} << n) - 1}, "");
}

std::uint64_t BitReader::take_exp_golomb(const char* element) {
  const std::uint64_t at = bit_pos();
  int zeros = 0;
  while (!error_ && take(1, element, at) == 0) {
    if (++zeros > 32) {
      fail(Errc::kInvalid, "R-BIT-04", element, at);
    }
  }
  if (error_) return 0;
  const std::uint64_t tail = zeros == 0 ? 0 : take(zeros, element, at);
  return (std::uint64_t{1} << zeros) - 1 + tail;
}

std::uint32_t BitReader::ue(const char* element, Range range, const char* rule) {
  assert(range.min >= 0 && range.max <= 0xFFFFFFFE);
  const std::uint64_t at = bit_pos();
  const auto code = static_cast<std::int64_t>(take_exp_golomb(element));
  return static_cast<std::uint32_t>(check(code, element, range, rule, at));
}

std::int32_t BitReader::se(const char* element, Range range, const char* rule) {
  const std::uint64_t at = bit_pos();
  const auto code = static_cast<std::int64_t>(take_exp_golomb(element));
  const std::int64_t value = code % 2 == 1 ? (code + 1) / 2 : -(code / 2);
  return static_cast<std::int32_t>(check(value, element, range, rule, at));
}

void BitReader::byte_alignment() {
  const std::uint64_t at = bit_pos();
  const int n = static_cast<int>((8 - pos_ % 8) % 8);
  if (n == 0) return;
  if (take(n, "alignment_zero_bits", at) != 0) {
    fail(Errc::kInvalid, "R-BIT-02", "alignment_zero_bits", at);
  }
}

std::span<const std::uint8_t> BitReader::remaining_bytes() const {
  assert(pos_ % 8 == 0);
  return bytes_.subspan(static_cast<std::size_t>(pos_ / 8));
}

void BitReader::expect_end() {
  if (pos_ != std::uint64_t{bytes_.size()} * 8)
    fail(Errc::kInvalid, "R-BIT-03", "unit_payload", bit_pos());
}

}  // namespace rlpc
