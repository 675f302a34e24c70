// Reads access units and shared rigs from a stream: collects their units and parses them.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/syntax/stream_context.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/kinds/skinned/parse/rig_parser.h"
#include "decoder/codec/options.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/units/access_unit_parser.h"
#include "decoder/codec/units/unit_cursor.h"
#include "decoder/codec/units/unit_reader.h"

namespace rlpc {

struct RawUnit {
  UnitHeader header;
  Vector<std::uint8_t> payload;
};

// Units of an access unit, of which only the GOF header is parsed.
struct RawAccessUnit {
  GofHeader gof;
  Vector<RawUnit> units;  // the GOF unit first

  // Returns the end of the units, bytes from the start of the stream.
  std::uint64_t end() const { return units.back().header.end(); }
  std::uint32_t end_frame() const { return gof.first_frame + gof.num_frames; }
};

class AccessUnitReader {
 public:
  // units and context must outlive the reader. Uses limits, cut, coarse_layers,
  // read_dropped_slices and verify_hashes of the options. Without verify_hashes, hash units are
  // not read, and the caller finds them as the next units.
  AccessUnitReader(UnitReader& units, const StreamContext& context,
                   const DecoderOptions& options)
      : units_(units),
        context_(context),
        memory_{options.limits.max_memory_bytes, 0},
        cut_(options.cut),
        read_dropped_(options.read_dropped_slices),
        wants_hash_(options.verify_hashes) {
    cut_.needed_layers = std::min(cut_.needed_layers, options.coarse_layers);
  }

  MemoryLimit memory_limit() const {
    return {memory_.max_bytes, memory_.bytes_in_use + cached_bytes_};
  }
  const SliceCut& cut() const { return cut_; }
  // Sets the cut of read() and read_rig() from now on.
  void set_cut(const SliceCut& cut) { cut_ = cut; }
  // Sets the memory that the rest of the decoder uses from now on.
  void set_bytes_in_use(std::uint64_t bytes) { memory_.bytes_in_use = bytes; }
  // Sets the additional memory of cached GOFs. Other threads may be parsing.
  void set_cached_bytes(std::uint64_t bytes) { cached_bytes_ = bytes; }

  // Reads and parses an access unit. gof_unit: its GOF unit; first_frame: the first_frame that
  // the GOF must have; rigs: the rigs alive at it.
  Result<AccessUnit> read(const UnitHeader& gof_unit, std::uint32_t first_frame,
                          const RigSlots& rigs);
  // Reads and parses a shared rig.
  Result<ParsedRig> read_rig(const UnitHeader& rig_unit, const RigSlots& rigs);
  // Returns the end of the last access unit or shared rig read, bytes from the start of the
  // stream.
  std::uint64_t end() const { return end_; }

  // Reads an access unit in two steps, collect() and parse(), of which parse() may run on
  // another thread. max_memory_bytes limits the payloads and, separately, the parsed result. If
  // a step fails, read() reports the error.
  std::optional<RawAccessUnit> collect(const UnitHeader& gof_unit, std::uint32_t first_frame,
                                       std::uint64_t max_memory_bytes);
  // cut: a copy that set_cut() does not change.
  Result<AccessUnit> parse(const RawAccessUnit& raw, const RigSlots& rigs, const SliceCut& cut,
                           std::uint64_t max_memory_bytes) const;
  // Read a shared rig in the same two steps. The first returns none in streams without rigs.
  std::optional<Vector<RawUnit>> collect_rig(const UnitHeader& rig_unit,
                                             std::uint64_t max_memory_bytes);
  Result<ParsedRig> parse_rig(const Vector<RawUnit>& raw, const RigSlots& rigs,
                              const SliceCut& cut, std::uint64_t max_memory_bytes) const;

 private:
  struct GofUnits;
  struct RigUnits;

  // Reads and parses the units of an access unit or of a shared rig, one by one.
  template <class Units>
  Result<bool> read_units(const UnitHeader& first, const RigSlots& rigs, Units& object);
  // Parses units that have been collected.
  template <class Units>
  Result<bool> parse_units(const Vector<RawUnit>& raw, const RigSlots& rigs,
                           const MemoryLimit& memory, Units& object) const;
  // Reads units. followers(first): which come after the first, once that has been read; none:
  // it is broken.
  template <class FollowersOf>
  std::optional<Vector<RawUnit>> collect_units(const UnitHeader& first,
                                               std::uint64_t max_memory_bytes,
                                               const FollowersOf& followers);
  MemoryLimit limit_ahead(std::uint64_t max_memory_bytes) const;
  // Returns an error unless the payload of a unit fits the limit, in addition to the memory
  // that its access unit or shared rig has taken.
  static Result<bool> check_fits(const UnitHeader& unit, std::uint64_t taken_bytes,
                                 const MemoryLimit& memory);
  // Returns whether the cut drops a slice, which need not be read.
  template <class Parser>
  Result<bool> is_dropped(const UnitHeader& unit, Parser& parser);
  // Reads the payload of a unit if it fits the limit.
  Result<Vector<std::uint8_t>> payload(const UnitHeader& unit, std::uint64_t taken_bytes);

  UnitReader& units_;
  const StreamContext& context_;
  MemoryLimit memory_;
  std::atomic<std::uint64_t> cached_bytes_ = 0;
  SliceCut cut_;
  bool read_dropped_;
  bool wants_hash_;
  std::uint64_t end_ = 0;
};

}  // namespace rlpc
