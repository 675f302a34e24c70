// The strict validator: everything that is wrong with a stream, not only what comes first.
//
//   auto source = rlpc::file_source("walk.rlpc");
//   if (!source) return report(source.error());
//   const rlpc::ValidationReport report = rlpc::validate(**source);
//   for (const rlpc::Finding& finding : report.findings) print(finding);
//
// It walks the units itself and goes on after an error where it can. Beside what the decoding
// process checks, it checks the requirements that a decoder need not check (clause 4.6), and
// warns of what is legal but surely not meant. Nothing throws; memory stays within one GOF and
// one frame, and limits are compared before memory is taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/result.h"
#include "common/syntax/sequence_header.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/stream/byte_source.h"

namespace rlpc {

enum class Severity : std::uint8_t {
  kError,        // the stream does not conform
  kUnsupported,  // of a later version, another profile or level
  kWarning,      // legal, but surely not meant
};

struct FindingUnit {
  std::uint32_t number = 0;  // counted from 0
  std::uint8_t type_byte = 0;
  std::uint64_t offset = 0;  // of the unit, bytes from the start of the stream
};

struct Finding {
  Severity severity = Severity::kError;
  const char* id = "";       // of a rule of the specification, or W-... of a warning
  const char* element = "";  // syntax element or structure
  std::uint64_t bit_pos = 0;
  std::optional<FindingUnit> unit;  // none for what stands outside of units
  std::string detail;               // values, where they help
  bool consequence = false;         // may follow from damage that was found before
  bool stops_decoder = false;       // what a decoder reports that stops at the first error
  std::uint32_t count = 1;          // places of a warning; the first of them is given
};

struct ValidationOptions {
  DecodeLimits limits;
  std::size_t max_findings = 1000;  // errors; more are only counted
  std::function<void(double)> progress;
};

struct ValidationReport {
  // In the order of the decoding process; then what shows only with the whole stream.
  std::vector<Finding> findings;
  std::uint64_t omitted = 0;     // errors beyond max_findings
  std::optional<Error> stopped;  // beyond the limits, or not readable: not all was checked
  bool complete = true;          // every syntax element was looked at
  std::optional<SequenceHeader> header;
  std::uint64_t bytes = 0;
  std::uint32_t units = 0;
  std::uint32_t gofs = 0;           // whose sections were read to the end
  std::uint32_t frames = 0;         // of these GOFs
  std::uint32_t hashed_frames = 0;  // whose positions have the hash that the stream gives

  std::size_t count(Severity severity) const;
  // What a decoder reports, or null if it decodes the stream.
  const Finding* first_failure() const;
};

ValidationReport validate(ByteSource& source, const ValidationOptions& options = {});

}  // namespace rlpc
