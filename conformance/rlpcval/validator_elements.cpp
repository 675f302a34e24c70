#include "conformance/rlpcval/validator_elements.h"

#include <string>
#include <string_view>
#include <utility>

namespace rlpc {
namespace {

std::string describe(std::string_view rule, const char* element, std::int64_t value,
                     Range allowed) {
  if (rule == "R-BIT-02") return "";
  if (rule == "R-BIT-03") return std::to_string((value + 7) / 8) + " bytes are left over";
  std::string text = std::string(element) + " is " + std::to_string(value);
  if (allowed.min == allowed.max) return text;
  const std::string where = rule.starts_with("R-LVL") ? " at this level" : "";
  if (allowed.min == 0) return text + "; at most " + std::to_string(allowed.max) + where;
  return text + "; " + std::to_string(allowed.min) + " to " + std::to_string(allowed.max) +
         " are allowed" + where;
}

}  // namespace

void ElementReader::add(const Error& error, std::string detail) {
  ++failures_;
  if (checked_ == Checked::kByDecoding || error.code == Errc::kLimitExceeded) {
    findings_.error(error, std::move(detail));
  } else {
    findings_.unchecked(error.rule, error.element, error.bit_pos, std::move(detail));
  }
}

void ElementReader::broken_rule(const Error& error, std::int64_t value, Range allowed) {
  if (allowed.max < allowed.min) return;  // not known
  add(error, describe(error.rule, error.element, value, allowed));
}

void ElementReader::failed(const Error& error) {
  if (error.bit_pos < first_bit_) return;  // of an element of another unit
  const bool is_short = error.code == Errc::kTruncated;
  add(error, is_short ? "the payload of " + std::to_string(payload_bytes_) +
                            " bytes ends within the element"
                      : "");
}

}  // namespace rlpc
