#include "conformance/rlpcval/validator_elements.h"

#include <utility>

namespace rlpc {

void ElementReader::fail(Errc code, const char* rule, std::string detail) {
  ++failures_;
  if (checked_ == Checked::kByDecoding) {
    findings_.error({code, rule, element_, element_pos_}, std::move(detail));
  } else {
    findings_.unchecked(rule, element_, element_pos_, std::move(detail));
  }
}

void ElementReader::begin(const char* element) {
  element_ = element;
  element_pos_ = bit_pos();
  value_ = 0;
}

bool ElementReader::bit() {
  if (!readable_) return false;
  if (pos_ >= 8 * std::uint64_t{bytes_.size()}) {
    readable_ = false;
    fail(Errc::kTruncated, "R-BIT-01",
         "the payload of " + std::to_string(bytes_.size()) + " bytes ends within the element");
    return false;
  }
  const unsigned byte = bytes_[static_cast<std::size_t>(pos_ / 8)];
  const bool one = ((byte >> (7 - pos_ % 8)) & 1U) != 0;
  ++pos_;
  return one;
}

std::int64_t ElementReader::u(int n, const char* element) {
  begin(element);
  std::int64_t value = 0;
  for (int i = 0; i < n; ++i) value = 2 * value + (bit() ? 1 : 0);
  return remember(readable_ ? value : 0);
}

std::int64_t ElementReader::ue(const char* element) {
  begin(element);
  int zeros = 0;
  while (readable_ && !bit()) {
    if (readable_ && ++zeros > 32) {
      readable_ = false;
      fail(Errc::kInvalid, "R-BIT-04", "");
    }
  }
  std::int64_t tail = 0;
  for (int i = 0; i < zeros && readable_; ++i) tail = 2 * tail + (bit() ? 1 : 0);
  return remember(readable_ ? (std::int64_t{1} << zeros) - 1 + tail : 0);
}

std::int64_t ElementReader::se(const char* element) {
  const std::int64_t code = ue(element);
  return remember(code % 2 == 1 ? (code + 1) / 2 : -(code / 2));
}

void ElementReader::byte_alignment() {
  begin("alignment_zero_bits");
  bool zero = true;
  while (readable_ && pos_ % 8 != 0) zero = !bit() && zero;
  if (readable_ && !zero) fail(Errc::kInvalid, "R-BIT-02", "");
}

void ElementReader::expect_end() {
  begin("unit_payload");
  const std::uint64_t end = 8 * std::uint64_t{bytes_.size()};
  if (readable_ && pos_ != end) {
    fail(Errc::kInvalid, "R-BIT-03",
         std::to_string((end - pos_ + 7) / 8) + " bytes are left over");
  }
}

bool ElementReader::check(bool condition, Errc code, const char* rule,
                          const std::string& allowed) {
  if (!readable_) return false;
  if (condition) return true;
  fail(code, rule, std::string(element_) + " is " + std::to_string(value_) + "; " + allowed);
  return false;
}

bool ElementReader::require(bool condition, const char* rule, const std::string& allowed) {
  return check(condition, Errc::kInvalid, rule, allowed);
}

bool ElementReader::supported(bool condition, const char* rule, const std::string& allowed) {
  return check(condition, Errc::kUnsupported, rule, allowed);
}

}  // namespace rlpc
