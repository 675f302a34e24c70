#include "decoder/codec/units/stream_rigs.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/syntax/stream_format.h"
#include "common/memory/owned.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"
#include "decoder/codec/units/unit_cursor.h"

namespace rlpc {

Error misplaced(const UnitHeader& unit, std::uint32_t version_minor) {
  const bool known = unit.ancillary() || is_known_type(unit.type(), version_minor);
  return Error{known ? Errc::kInvalid : Errc::kUnsupported, known ? "R-UNT-05" : "R-UNT-04",
               "unit_type", unit.offset * 8};
}

void StreamRigs::put(std::uint64_t offset, Entry entry) {
  const auto [place, is_new] = entries_.try_emplace(offset);
  if (!is_new) offsets_[place->second.rig_idx].erase(offset);
  offsets_[entry.rig_idx].insert(offset);
  if (entry.rig) kept_.insert(offset);
  place->second = std::move(entry);
}

void StreamRigs::add(const Vector<RigLocation>& locations) {
  for (const RigLocation& l : locations) {
    if (!entries_.contains(l.offset)) put(l.offset, {l.rig_idx, 0, nullptr, {}});
  }
}

void StreamRigs::add(std::uint64_t offset, std::uint64_t end, const ParsedRig& parsed) {
  put(offset, {parsed.rig_idx, end, parsed.rig, {}});
}

Vector<std::uint64_t> StreamRigs::alive_at(std::uint64_t offset) const {
  Vector<std::uint64_t> alive;
  for (const Set<std::uint64_t>& slot_offsets : offsets_) {
    const auto after = slot_offsets.lower_bound(offset);
    if (after != slot_offsets.begin()) alive.push_back(*std::prev(after));
  }
  std::sort(alive.begin(), alive.end());
  return alive;
}

Result<bool> StreamRigs::parse(std::uint64_t offset, Entry& entry, const RigSlots& rigs) {
  const auto unit = units_.header_at(offset);
  if (!unit) return unit.error();
  if (unit->type() != UnitType::kRig) return misplaced(*unit, units_.version_minor());
  const auto parsed = access_units_.read_rig(*unit, rigs);
  if (!parsed) return parsed.error();
  if (parsed->rig_idx != entry.rig_idx) {
    return Error{Errc::kInvalid, "R-IDX-06", "index_rig_idx", access_units_.end() * 8};
  }
  entry.end = access_units_.end();
  entry.rig = parsed->rig;
  kept_.insert(offset);
  return true;
}

bool StreamRigs::take_back(std::uint64_t offset, Entry& entry) {
  if (!entry.rig && (entry.rig = entry.dropped.lock())) kept_.insert(offset);
  return entry.rig != nullptr;
}

Result<RigSlots> StreamRigs::at(std::uint64_t gof_offset) {
  const Vector<std::uint64_t> alive = alive_at(gof_offset);
  const auto num_dropped = std::erase_if(kept_, [&](std::uint64_t offset) {
    const bool drop = !std::binary_search(alive.begin(), alive.end(), offset);
    if (drop) {
      Entry& entry = entries_[offset];
      entry.dropped = std::exchange(entry.rig, nullptr);
    }
    return drop;
  });
  if (num_dropped > 0 && dropped_) dropped_();
  RigSlots rigs;
  for (const std::uint64_t offset : alive) {
    Entry& entry = entries_[offset];
    if (!take_back(offset, entry)) {
      if (const auto ok = parse(offset, entry, rigs); !ok) return ok.error();
    }
    rigs.slots[entry.rig_idx] = entry.rig;
  }
  return rigs;
}

Vector<StreamRigs::Alive> StreamRigs::find_alive(std::uint64_t gof_offset) const {
  Vector<Alive> alive;
  for (const std::uint64_t offset : alive_at(gof_offset)) {
    const Entry& entry = entries_.at(offset);
    alive.push_back({offset, entry.rig_idx, entry.rig ? entry.rig : entry.dropped.lock()});
  }
  return alive;
}

Result<std::uint64_t> StreamRigs::read(const UnitHeader& unit) {
  const auto known = entries_.find(unit.offset);
  if (known == entries_.end() || !take_back(unit.offset, known->second)) {
    const auto rigs = at(unit.offset);
    if (!rigs) return rigs.error();
    const auto parsed = access_units_.read_rig(unit, *rigs);
    if (!parsed) return parsed.error();
    add(unit.offset, access_units_.end(), *parsed);
    if (see_) see_(*parsed);
  }
  return entries_[unit.offset].end;
}

Result<std::uint64_t> StreamRigs::skip(const UnitHeader& unit) {
  const auto known = entries_.find(unit.offset);
  if (known != entries_.end() && known->second.end > 0) return known->second.end;
  const auto bytes = units_.payload_start(unit, 1);
  if (!bytes) return bytes.error();
  BitReader r = units_.bits(unit, *bytes);
  const std::uint32_t rig_idx = parse_rig_idx(r);
  if (r.error()) return *r.error();
  UnitCursor cursor(units_, unit);
  for (bool more = true; more;) {
    const auto advanced = cursor.advance({UnitType::kSlice});
    if (!advanced) return advanced.error();
    more = *advanced;
  }
  put(unit.offset, {rig_idx, cursor.end(), nullptr, {}});
  return cursor.end();
}

}  // namespace rlpc
