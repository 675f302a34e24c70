// Access units from the units of a stream.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/result.h"
#include "common/syntax/access_unit.h"
#include "common/syntax/stream_context.h"
#include "decoder/parse/access_unit_parser.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/stream/unit_reader.h"

namespace rlpc {

// The units of an access unit, of which only the GOF header has been parsed.
struct CodedAccessUnit {
  struct Unit {
    UnitHeader header;
    std::vector<std::uint8_t> payload;
  };
  GofHeader gof;
  std::vector<Unit> units;  // the GOF unit first

  std::uint64_t end() const { return units.back().header.end(); }  // in the stream, bytes
  std::uint32_t end_frame() const { return gof.first_frame + gof.num_frames; }
};

class AccessUnitReader {
 public:
  // Units and context must outlive it. Uses limits, cut and verify_hashes of the options;
  // without the latter, hash units are left to the caller.
  AccessUnitReader(UnitReader& units, const StreamContext& context,
                   const DecoderOptions& options)
      : units_(units),
        context_(context),
        max_memory_bytes_(options.limits.max_memory_bytes),
        cut_(options.cut),
        wants_hash_(options.verify_hashes) {}

  // gof_unit: a GOF unit; first_frame: the first frame that its GOF must have.
  Result<AccessUnit> read(const UnitHeader& gof_unit, std::uint32_t first_frame);
  // End of the units read last, bytes from the start of the stream.
  std::uint64_t end() const { return end_; }

  // The same in two steps, the second of which may run on another thread. max_memory_bytes
  // limits the payloads, and separately the parsed result. If either fails, read() reports the
  // error.
  std::optional<CodedAccessUnit> collect(const UnitHeader& gof_unit, std::uint32_t first_frame,
                                         std::uint64_t max_memory_bytes);
  Result<AccessUnit> parse(const CodedAccessUnit& coded, std::uint64_t max_memory_bytes) const;

 private:
  Result<bool> parse_unit(AccessUnitParser& parser, const UnitHeader& unit,
                          const std::vector<std::uint8_t>& payload,
                          std::uint32_t first_frame) const;
  Result<std::optional<UnitHeader>> unit_after(const UnitHeader& unit, bool has_slices);

  UnitReader& units_;
  const StreamContext& context_;
  std::uint64_t max_memory_bytes_;
  SliceCut cut_;
  bool wants_hash_;
  std::uint64_t end_ = 0;
};

}  // namespace rlpc
