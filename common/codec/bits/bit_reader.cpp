#include "common/codec/bits/bit_reader.h"

#include <algorithm>
#include <cassert>

namespace rlpc {
namespace {

constexpr std::int64_t kMaxCode = 0xFFFFFFFE;  // 2^32 - 2: the highest value of ue()

}  // namespace

void BitReader::fail(Errc code, const char* rule, const char* element, std::uint64_t bit_pos,
                     std::uint64_t needed_bytes) {
  if (stopped_) return;
  stopped_ = true;
  const Error error{code, rule, element, bit_pos, needed_bytes};
  if (!error_) error_ = error;
  if (listener_ != nullptr) listener_->failed(error);
}

void BitReader::break_rule(const ReadElement& element, Range range, const char* rule,
                           AfterBroken after) {
  if (listener_ == nullptr) return fail(Errc::kInvalid, rule, element.name, element.bit_pos);
  if (stopped_) return;
  const Error error{Errc::kInvalid, rule, element.name, element.bit_pos};
  if (!error_) error_ = error;
  broken_at_ = element.bit_pos;
  listener_->broken_rule(error, element.value, range);
  if (after == AfterBroken::kStop) stop();
}

bool BitReader::require(const ReadElement& element, Range range, const char* rule) {
  if (stopped_ || (error_ && broken_at_ == element.bit_pos)) return false;
  const bool holds = element.value >= range.min && element.value <= range.max;
  if (!holds) break_rule(element, range, rule);
  return holds;
}

bool BitReader::require(const ReadElement& element, bool holds, const char* rule) {
  const std::int64_t allowed = holds ? element.value : element.value + 1;
  return require(element, Range{allowed, allowed}, rule);
}

std::uint32_t BitReader::take(int n, const char* element, std::uint64_t at) {
  if (stopped_) return 0;
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

std::int64_t BitReader::check(const ReadElement& element, Range range, const char* rule,
                              AfterBroken after) {
  if (stopped_) return range.min;
  if (trace_ != nullptr) trace_->element(element.name, element.value, element.bit_pos);
  if (element.value >= range.min && element.value <= range.max) return element.value;
  break_rule(element, range, rule, after);
  return stopped_ ? range.min : std::min(element.value, kMaxCode);
}

std::uint32_t BitReader::u(int n, const char* element, Range range, const char* rule,
                           AfterBroken after) {
  assert(n >= 1 && n <= 32);
  const std::uint64_t at = bit_pos();
  const std::int64_t value = take(n, element, at);
  return static_cast<std::uint32_t>(check({element, value, at}, range, rule, after));
}

std::uint32_t BitReader::u(int n, const char* element) {
  return u(n, element, {0, (std::int64_t{1} << n) - 1}, "");
}

std::uint64_t BitReader::take_exp_golomb(const char* element) {
  const std::uint64_t at = bit_pos();
  int zeros = 0;
  while (!stopped_ && take(1, element, at) == 0) {
    if (++zeros > 32) {
      fail(Errc::kInvalid, "R-BIT-04", element, at);
    }
  }
  if (stopped_) return 0;
  const std::uint64_t tail = zeros == 0 ? 0 : take(zeros, element, at);
  return (std::uint64_t{1} << zeros) - 1 + tail;
}

std::uint32_t BitReader::ue(const char* element, Range range, const char* rule,
                            AfterBroken after) {
  assert(range.min >= 0 && range.max <= kMaxCode);
  const std::uint64_t at = bit_pos();
  const auto code = static_cast<std::int64_t>(take_exp_golomb(element));
  return static_cast<std::uint32_t>(check({element, code, at}, range, rule, after));
}

std::int32_t BitReader::se(const char* element, Range range, const char* rule) {
  const std::uint64_t at = bit_pos();
  const auto code = static_cast<std::int64_t>(take_exp_golomb(element));
  const std::int64_t value = code % 2 == 1 ? (code + 1) / 2 : -(code / 2);
  return static_cast<std::int32_t>(
      check({element, value, at}, range, rule, AfterBroken::kGoOn));
}

void BitReader::byte_alignment() {
  const std::uint64_t at = bit_pos();
  const int n = static_cast<int>((8 - pos_ % 8) % 8);
  if (n == 0) return;
  const std::uint32_t bits = take(n, "alignment_zero_bits", at);
  if (bits != 0) break_rule({"alignment_zero_bits", bits, at}, {0, 0}, "R-BIT-02");
}

std::span<const std::uint8_t> BitReader::remaining_bytes() const {
  assert(pos_ % 8 == 0);
  return bytes_.subspan(static_cast<std::size_t>(pos_ / 8));
}

void BitReader::expect_end() {
  const std::uint64_t left = std::uint64_t{bytes_.size()} * 8 - pos_;
  const ReadElement rest{"unit_payload", static_cast<std::int64_t>(left), bit_pos()};
  if (left != 0) break_rule(rest, {0, 0}, "R-BIT-03");
}

}  // namespace rlpc
