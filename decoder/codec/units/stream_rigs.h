// Shared rigs of a stream: their places, and those that a GOF can use.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/kinds/skinned/parse/rig_parser.h"
#include "decoder/codec/parse/sequence/parse_gof_index.h"
#include "decoder/codec/units/access_unit_reader.h"
#include "decoder/codec/units/unit_reader.h"

namespace rlpc {

// 6.2 CheckUnitType( expected ): returns the error of a unit in the wrong place, or of a
// critical unit of unknown type.
Error misplaced(const UnitHeader& unit, std::uint32_t version_minor);

class StreamRigs {
 public:
  // Both arguments must outlive it.
  StreamRigs(UnitReader& units, AccessUnitReader& access_units)
      : units_(units), access_units_(access_units) {}

  // Adds the rigs that the GOF index lists, without parsing them.
  void add(const Vector<RigLocation>& locations);
  // Adds a rig that was parsed elsewhere. end: end of its units, bytes from the start of the
  // stream.
  void add(std::uint64_t offset, std::uint64_t end, const ParsedRig& parsed);

  // Parses the rig unit that the stream is at with its slices, unless it is already parsed.
  // Returns the end of its units.
  Result<std::uint64_t> read(const UnitHeader& unit);
  // Finds the index and the end of that rig without parsing it. Returns the end of its units.
  Result<std::uint64_t> skip(const UnitHeader& unit);
  // Returns the rigs alive at the GOF unit at an offset: parses those that are not kept, and
  // drops all others.
  Result<RigSlots> at(std::uint64_t gof_offset);
  // Returns the same rigs, in the order of the stream, without parsing or dropping any.
  struct Alive {
    std::uint64_t offset = 0;
    std::uint32_t rig_idx = 0;
    std::shared_ptr<const SharedRig> rig;  // null: not parsed
  };
  Vector<Alive> find_alive(std::uint64_t gof_offset) const;

  // Sets a function to call with each shared rig that read() parses.
  using See = std::function<void(const ParsedRig& rig)>;
  void watch(See see) { see_ = std::move(see); }
  // Sets a function to call after rigs have been dropped.
  void when_dropped(std::function<void()> dropped) { dropped_ = std::move(dropped); }

 private:
  struct Entry {
    std::uint32_t rig_idx = 0;
    std::uint64_t end = 0;                   // 0: not known
    std::shared_ptr<const SharedRig> rig;    // null: not parsed, or dropped
    std::weak_ptr<const SharedRig> dropped;  // alive while a cached GOF uses it
  };
  // Returns the offsets of the rigs alive at an offset, in the order of the stream.
  Vector<std::uint64_t> alive_at(std::uint64_t offset) const;
  void put(std::uint64_t offset, Entry entry);
  // Restores a dropped rig that has another owner. Returns whether the entry has its rig.
  bool take_back(std::uint64_t offset, Entry& entry);
  Result<bool> parse(std::uint64_t offset, Entry& entry, const RigSlots& rigs);

  UnitReader& units_;
  AccessUnitReader& access_units_;
  Map<std::uint64_t, Entry> entries_;                 // key: offset
  std::array<Set<std::uint64_t>, kMaxRigs> offsets_;  // [rig_idx] offsets of entries
  Set<std::uint64_t> kept_;                           // offsets of entries with a rig
  See see_;
  std::function<void()> dropped_;
};

}  // namespace rlpc
