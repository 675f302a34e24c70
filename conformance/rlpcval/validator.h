// The strict validator: reports all violations in a stream, not only the first.
//
//   auto source = rlpc::file_source("walk.rlpc");
//   if (!source) return report(source.error());
//   const rlpc::ValidationReport report = rlpc::validate(**source);
//   for (const rlpc::Finding& finding : report.findings) print(finding);
//
// It walks the units itself and continues after an error where it can. In addition to the
// checks of the decoding process, it checks the requirements that a decoder need not check
// (clause 4.6), and warns of what is legal but surely not intended. Nothing throws; memory is
// bounded by one GOF, the shared rigs it can use and one frame; limits are checked before
// allocating.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/codec/syntax/sequence_header.h"
#include "common/result.h"
#include "decoder/codec/units/byte_source.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {

enum class Severity : std::uint8_t {
  kError,        // the stream does not conform
  kUnsupported,  // a later version, another profile or level
  kWarning,      // legal, but surely not intended
};

struct FindingUnit {
  std::uint32_t number = 0;  // counted from 0
  std::uint8_t type_byte = 0;
  std::uint64_t offset = 0;  // bytes from the start of the stream
};

struct Finding {
  Severity severity = Severity::kError;
  const char* id = "";       // rule of the specification, or W-... for a warning
  const char* element = "";  // syntax element or structure
  std::uint64_t bit_pos = 0;
  std::optional<FindingUnit> unit;  // none outside of units
  std::string detail;               // values, where they help
  bool consequence = false;         // may be a consequence of an earlier finding
  bool stops_decoder = false;       // the one that a decoder reports, as it stops there
  std::uint32_t count = 1;          // occurrences of a warning; the position is of the first
};

struct ValidationOptions {
  DecodeLimits limits;
  std::size_t max_findings = 1000;  // errors listed; more are only counted
  std::function<void(double)> progress;
};

struct ValidationReport {
  // In the order of the decoding process; findings that need the whole stream come last.
  std::vector<Finding> findings;
  std::uint64_t omitted = 0;     // errors beyond max_findings
  std::optional<Error> stopped;  // limits exceeded or not readable: not checked completely
  bool complete = true;          // every syntax element was checked
  std::optional<SequenceHeader> header;
  std::uint64_t bytes = 0;
  std::uint32_t units = 0;
  std::uint32_t gofs = 0;    // GOFs whose sections were read to the end
  std::uint32_t frames = 0;  // frames of these GOFs
  std::uint32_t attribute_sets = 0;
  std::uint32_t hashed_frames = 0;          // frames whose positions match their hash
  std::uint32_t gofs_of_hashed_frames = 0;  // inter GOFs, each of whose frames has a hash

  std::size_t count(Severity severity) const;
  // Returns the finding that a decoder reports; null if none of them stops it (see `stopped`).
  const Finding* first_failure() const;
};

ValidationReport validate(ByteSource& source, const ValidationOptions& options = {});

}  // namespace rlpc
