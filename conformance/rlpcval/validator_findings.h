// Collects findings, with the current unit.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/result.h"
#include "conformance/rlpcval/validator.h"

namespace rlpc {

// Returns a CRC or signature as details of findings show it: 0x0123ABCD.
std::string hex(std::uint32_t value);

class FindingList {
 public:
  FindingList(ValidationReport& report, std::size_t max_findings)
      : report_(report), max_findings_(max_findings) {}

  // Sets the unit of later findings.
  void in_unit(const std::optional<FindingUnit>& unit) { unit_ = unit; }
  // Sets whether later findings may be consequences of earlier ones.
  void suspect(bool suspect) { suspect_ = suspect; }
  bool suspect() const { return suspect_; }

  // A violation that the decoding process checks: a decoder stops at the first.
  void error(const Error& error, std::string detail = "");
  // A violation that sequential decoding does not check (4.6).
  void unchecked(const char* rule, const char* element, std::uint64_t bit_pos,
                 std::string detail);
  void warning(const char* id, const char* element, std::uint64_t bit_pos, std::string detail);

  // Number of errors and unsupported features so far, including those not listed.
  std::uint64_t failures() const { return failures_; }

 private:
  Finding make(Severity severity, const Error& error, std::string detail) const;
  void add(Finding finding);

  ValidationReport& report_;
  std::size_t max_findings_;
  std::optional<FindingUnit> unit_;
  bool suspect_ = false;
  bool stopped_ = false;  // a decoder would have stopped
  std::uint64_t failures_ = 0;
};

}  // namespace rlpc
