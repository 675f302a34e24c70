// The shared rigs of a stream: where they are, and those that a GOF can use.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/parse/rig_parser.h"
#include "decoder/codec/parse/sequence/parse_gof_index.h"
#include "decoder/codec/units/access_unit_reader.h"
#include "decoder/codec/units/unit_reader.h"

namespace rlpc {

// 6.2 CheckUnitType( expected ): the error of a unit in the wrong place, or of a critical one
// that this version does not know.
Error misplaced(const UnitHeader& unit, std::uint32_t version_minor);

class StreamRigs {
 public:
  // Both must outlive it.
  StreamRigs(UnitReader& units, AccessUnitReader& access_units)
      : units_(units), access_units_(access_units) {}

  // What is known without parsing it: the list of the GOF index.
  void add(const Vector<RigLocation>& locations);
  // A rig that was parsed elsewhere; end: of its units, bytes from the start of the stream.
  void add(std::uint64_t offset, std::uint64_t end, const ParsedRig& parsed);

  // A rig unit that the stream is at: parses it with its slices, unless that has been
  // done. Returns the end of its units.
  Result<std::uint64_t> read(const UnitHeader& unit);
  // The same, but only finds out its index and its end.
  Result<std::uint64_t> skip(const UnitHeader& unit);
  // Those alive at a GOF unit, by its offset; parses those that are not kept, and drops all
  // others.
  Result<RigSlots> at(std::uint64_t gof_offset);
  // The same rigs, in the order of the stream, without parsing or dropping any.
  struct Alive {
    std::uint64_t offset = 0;
    std::uint32_t rig_idx = 0;
    std::shared_ptr<const SharedRig> rig;  // null: has to be parsed
  };
  Vector<Alive> find_alive(std::uint64_t gof_offset) const;

  // Calls `see` with each shared rig that read() parses.
  using See = std::function<void(const ParsedRig& rig)>;
  void watch(See see) { see_ = std::move(see); }
  // Calls `dropped` when rigs have been dropped.
  void when_dropped(std::function<void()> dropped) { dropped_ = std::move(dropped); }

 private:
  struct Entry {
    std::uint32_t rig_idx = 0;
    std::uint64_t end = 0;                   // 0: not known
    std::shared_ptr<const SharedRig> rig;    // null: not parsed, or dropped
    std::weak_ptr<const SharedRig> dropped;  // while a GOF that is kept uses it
  };
  // In the order of the stream.
  Vector<std::uint64_t> alive_at(std::uint64_t offset) const;
  void put(std::uint64_t offset, Entry entry);
  // Whether the rig is there, possibly because somebody else has kept it.
  bool take_back(std::uint64_t offset, Entry& entry);
  Result<bool> parse(std::uint64_t offset, Entry& entry, const RigSlots& rigs);

  UnitReader& units_;
  AccessUnitReader& access_units_;
  Map<std::uint64_t, Entry> entries_;                 // by offset
  std::array<Set<std::uint64_t>, kMaxRigs> offsets_;  // of the entries, by rig_idx
  Set<std::uint64_t> kept_;                           // those whose rig is there
  See see_;
  std::function<void()> dropped_;
};

}  // namespace rlpc
