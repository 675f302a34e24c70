#include "decoder/codec/units/access_unit_reader.h"

#include <algorithm>
#include <utility>

#include "common/memory/owned.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "decoder/codec/parse/rig_memory.h"
#include "decoder/codec/units/unit_cursor.h"

namespace rlpc {
namespace {

// The units after the GOF unit. A GOF whose frames are output before it ends has hashes in its
// frame units (7.2).
Followers followers_of_gof(const SequenceHeader& header, GofKind kind, bool wants_hash) {
  return {slice_type(kind), wants_hash && !is_live(header, kind)};
}

// The units after a rig unit: another unit always follows, if only the end of the sequence.
constexpr Followers kFollowersOfRig{UnitType::kSlice, false, true};

}  // namespace

// The parser of an access unit, as read_units() and parse_units() see it.
struct AccessUnitReader::GofUnits {
  AccessUnitParser parser;
  const SequenceHeader& header;
  std::uint32_t first_frame;
  bool wants_hash;

  Followers followers() const { return followers_of_gof(header, parser.kind(), wants_hash); }
  Result<bool> parse(BitReader& r, const UnitHeader& unit, const RigSlots& rigs) {
    const std::uint64_t unit_bytes = unit.end() - unit.offset;
    switch (unit.type()) {
      case UnitType::kGof:
        return parser.gof(r, first_frame, rigs, unit_bytes);
      case UnitType::kSlice:
      case UnitType::kFrame:
        return parser.slice(r, unit.offset * 8, unit_bytes);
      default:
        return parser.hash(r);
    }
  }
};

// The parser of a shared rig.
struct AccessUnitReader::RigUnits {
  RigParser parser;

  static Followers followers() { return kFollowersOfRig; }
  Result<bool> parse(BitReader& r, const UnitHeader& unit, const RigSlots& rigs) {
    const std::uint64_t unit_bytes = unit.end() - unit.offset;
    return unit.type() == UnitType::kRig ? parser.rig(r, rigs, unit_bytes)
                                         : parser.slice(r, unit.offset * 8, unit_bytes);
  }
};

template <class Parser>
Result<bool> AccessUnitReader::is_dropped(const UnitHeader& unit, Parser& parser) {
  constexpr std::uint32_t kEnough = 17;  // 3 bits, and two codes of at most 63
  if (read_dropped_ || unit.type() != UnitType::kSlice) return false;
  const auto bytes = units_.payload_start(unit, kEnough);
  if (!bytes) return bytes.error();
  BitReader r = units_.bits(unit, *bytes);
  return parser.drops(r);
}

template <class Units>
Result<bool> AccessUnitReader::read_units(const UnitHeader& first, const RigSlots& rigs,
                                          Units& object) {
  const std::uint64_t rig_bytes = memory_of_rigs(rigs);
  UnitCursor cursor(units_, first);
  for (;;) {
    const UnitHeader& unit = cursor.unit();
    const auto dropped = is_dropped(unit, object.parser);
    if (!dropped) return dropped.error();
    if (!*dropped) {
      const auto bytes = payload(unit, std::max(rig_bytes, object.parser.memory_bytes()));
      if (!bytes) return bytes.error();
      BitReader r = units_.bits(unit, *bytes);
      if (auto ok = object.parse(r, unit, rigs); !ok) return ok;
    }
    end_ = cursor.end();
    const auto more = cursor.advance(object.followers());
    if (!more || !*more) return more;
  }
}

template <class Units>
Result<bool> AccessUnitReader::parse_units(const Vector<RawUnit>& raw, const RigSlots& rigs,
                                           const MemoryLimit& memory, Units& object) const {
  const std::uint64_t rig_bytes = memory_of_rigs(rigs);
  for (const auto& [unit, payload] : raw) {
    const std::uint64_t taken_bytes = std::max(rig_bytes, object.parser.memory_bytes());
    if (auto ok = check_fits(unit, taken_bytes, memory); !ok) return ok;
    BitReader r = units_.bits(unit, payload);
    if (auto ok = object.parse(r, unit, rigs); !ok) return ok;
  }
  return true;
}

template <class FollowersOf>
std::optional<Vector<RawUnit>> AccessUnitReader::collect_units(const UnitHeader& first,
                                                               std::uint64_t max_memory_bytes,
                                                               const FollowersOf& followers) {
  Vector<RawUnit> raw;
  std::optional<Followers> follow;
  std::uint64_t num_bytes = 0;
  UnitCursor cursor(units_, first);
  for (;;) {
    num_bytes += cursor.unit().size;
    if (num_bytes > max_memory_bytes) return std::nullopt;
    auto payload = units_.payload(cursor.unit());
    if (!payload) return std::nullopt;
    raw.push_back({cursor.unit(), std::move(*payload)});
    if (!follow) follow = followers(raw.front());
    if (!follow) return std::nullopt;
    const auto more = cursor.advance(*follow);
    if (!more) return std::nullopt;
    if (!*more) return raw;
  }
}

Result<AccessUnit> AccessUnitReader::read(const UnitHeader& gof_unit, std::uint32_t first_frame,
                                          const RigSlots& rigs) {
  GofUnits object{{context_, memory_limit(), cut_}, context_.header, first_frame, wants_hash_};
  if (auto ok = read_units(gof_unit, rigs, object); !ok) return ok.error();
  return object.parser.finish();
}

Result<ParsedRig> AccessUnitReader::read_rig(const UnitHeader& rig_unit, const RigSlots& rigs) {
  RigUnits object{{context_, memory_limit(), cut_}};
  if (auto ok = read_units(rig_unit, rigs, object); !ok) return ok.error();
  return object.parser.finish();
}

std::optional<RawAccessUnit> AccessUnitReader::collect(const UnitHeader& gof_unit,
                                                       std::uint32_t first_frame,
                                                       std::uint64_t max_memory_bytes) {
  RawAccessUnit raw;
  auto units = collect_units(
      gof_unit, max_memory_bytes, [&](const RawUnit& first) -> std::optional<Followers> {
        BitReader r = units_.bits(first.header, first.payload);
        raw.gof = parse_gof_header(r, context_.header, first_frame);
        if (r.error()) return std::nullopt;
        return followers_of_gof(context_.header, raw.gof.kind, wants_hash_);
      });
  if (!units) return std::nullopt;
  raw.units = std::move(*units);
  return raw;
}

std::optional<Vector<RawUnit>> AccessUnitReader::collect_rig(const UnitHeader& rig_unit,
                                                             std::uint64_t max_memory_bytes) {
  if (!context_.meshes) return std::nullopt;
  return collect_units(rig_unit, max_memory_bytes, [](const RawUnit&) {
    return std::optional<Followers>(kFollowersOfRig);
  });
}

Result<AccessUnit> AccessUnitReader::parse(const RawAccessUnit& raw, const RigSlots& rigs,
                                           const SliceCut& cut,
                                           std::uint64_t max_memory_bytes) const {
  const MemoryLimit memory = limit_ahead(max_memory_bytes);
  GofUnits object{{context_, memory, cut}, context_.header, raw.gof.first_frame, wants_hash_};
  if (auto ok = parse_units(raw.units, rigs, memory, object); !ok) return ok.error();
  return object.parser.finish();
}

Result<ParsedRig> AccessUnitReader::parse_rig(const Vector<RawUnit>& raw, const RigSlots& rigs,
                                              const SliceCut& cut,
                                              std::uint64_t max_memory_bytes) const {
  const MemoryLimit memory = limit_ahead(max_memory_bytes);
  RigUnits object{{context_, memory, cut}};
  if (auto ok = parse_units(raw, rigs, memory, object); !ok) return ok.error();
  return object.parser.finish();
}

// Returns a limit with which parse() runs out of memory whenever read() would.
MemoryLimit AccessUnitReader::limit_ahead(std::uint64_t max_memory_bytes) const {
  const MemoryLimit limit = memory_limit();
  const std::uint64_t left = limit.max_bytes - std::min(limit.max_bytes, limit.bytes_in_use);
  return {std::min(max_memory_bytes, left), 0};
}

Result<bool> AccessUnitReader::check_fits(const UnitHeader& unit, std::uint64_t taken_bytes,
                                          const MemoryLimit& memory) {
  const std::uint64_t needed_bytes = memory.bytes_in_use + taken_bytes + unit.size;
  if (needed_bytes <= memory.max_bytes) return true;
  return Error{Errc::kLimitExceeded, "", "unit_size", unit.offset * 8 + 8, needed_bytes};
}

Result<Vector<std::uint8_t>> AccessUnitReader::payload(const UnitHeader& unit,
                                                       std::uint64_t taken_bytes) {
  if (auto ok = check_fits(unit, taken_bytes, memory_limit()); !ok) return ok.error();
  return units_.payload(unit);
}

}  // namespace rlpc
