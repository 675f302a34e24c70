// Reads payloads with the decoder's parse functions, which go on after values that break a
// rule, so that all values of a header are checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/bits/bit_reader.h"
#include "conformance/rlpcval/validator_findings.h"
#include "decoder/codec/units/unit_reader.h"

namespace rlpc {

// Whether the decoding process checks the elements read.
enum class Checked : std::uint8_t { kByDecoding, kNotByDecoding };

// Reader of a payload that reports every broken rule of its elements as a finding.
class ElementReader final : private RuleListener {
 public:
  ElementReader(const UnitHeader& unit, const std::vector<std::uint8_t>& payload,
                FindingList& findings, Checked checked = Checked::kByDecoding)
      : bits_(payload, unit.payload_offset() * 8, nullptr, this),
        first_bit_(unit.payload_offset() * 8),
        payload_bytes_(payload.size()),
        findings_(findings),
        checked_(checked) {}

  BitReader& bits() { return bits_; }
  // Returns false once a code was invalid or passed the end of the payload, or elements could
  // not be known; later values are the lowest legal ones.
  bool readable() const { return !bits_.stopped(); }
  // Number of findings so far.
  std::uint32_t failures() const { return failures_; }

 private:
  void broken_rule(const Error& error, std::int64_t value, Range allowed) override;
  void failed(const Error& error) override;
  void add(const Error& error, std::string detail);

  BitReader bits_;
  std::uint64_t first_bit_;
  std::size_t payload_bytes_;
  FindingList& findings_;
  Checked checked_;
  std::uint32_t failures_ = 0;
};

}  // namespace rlpc
