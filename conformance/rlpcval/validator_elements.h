// Fixed-length and Exp-Golomb codes of clause 9.2 for the validator: a value out of range is
// reported and reading continues, so that all values of a header are checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "conformance/rlpcval/validator_findings.h"

namespace rlpc {

// Whether the decoding process checks the elements read.
enum class Checked : std::uint8_t { kByDecoding, kNotByDecoding };

class ElementReader {
 public:
  ElementReader(std::span<const std::uint8_t> payload, std::uint64_t first_bit,
                FindingList& findings, Checked checked = Checked::kByDecoding)
      : bytes_(payload), first_bit_(first_bit), findings_(findings), checked_(checked) {}

  std::int64_t u(int n, const char* element);
  std::int64_t ue(const char* element);
  std::int64_t se(const char* element);
  void byte_alignment();
  void expect_end();

  // Reports a rule at the last element, unless that could not be read. Returns `condition`.
  bool require(bool condition, const char* rule, const std::string& allowed);
  bool supported(bool condition, const char* rule, const std::string& allowed);

  // Returns false once a code was invalid or passed the end of the payload; later values are 0.
  bool readable() const { return readable_; }
  std::uint64_t bit_pos() const { return first_bit_ + pos_; }
  std::uint32_t failures() const { return failures_; }

 private:
  bool bit();
  std::int64_t remember(std::int64_t value) { return value_ = value; }
  void begin(const char* element);
  bool check(bool condition, Errc code, const char* rule, const std::string& allowed);
  void fail(Errc code, const char* rule, std::string detail);

  std::span<const std::uint8_t> bytes_;
  std::uint64_t pos_ = 0;
  std::uint64_t first_bit_;
  FindingList& findings_;
  Checked checked_;
  bool readable_ = true;
  std::uint32_t failures_ = 0;
  // The element read last.
  const char* element_ = "";
  std::uint64_t element_pos_ = 0;
  std::int64_t value_ = 0;
};

}  // namespace rlpc
