#include "decoder/codec/units/access_unit_reader.h"

#include <algorithm>
#include <utility>

#include "common/memory/owned.h"
#include "decoder/codec/parse/memory_estimate.h"
#include "decoder/codec/parse/parse_gof_header.h"

namespace rlpc {

template <class Parser>
Result<bool> AccessUnitReader::is_dropped(const UnitHeader& unit, Parser& parser) {
  constexpr std::uint32_t kEnough = 17;  // 3 bits, and two codes of at most 63
  if (read_dropped_ || unit.type() != UnitType::kSlice) return false;
  const auto bytes = units_.payload_start(unit, kEnough);
  if (!bytes) return bytes.error();
  BitReader r = units_.bits(unit, *bytes);
  return parser.drops(r);
}

Result<AccessUnit> AccessUnitReader::read(const UnitHeader& gof_unit, std::uint32_t first_frame,
                                          const RigSlots& rigs) {
  AccessUnitParser parser(context_, memory_limit(), cut_);
  const std::uint64_t of_rigs = memory_of_rigs(rigs);
  for (std::optional<UnitHeader> unit = gof_unit; unit;) {
    const auto dropped = is_dropped(*unit, parser);
    if (!dropped) return dropped.error();
    if (!*dropped) {
      const auto bytes = payload(*unit, std::max(of_rigs, parser.memory_bytes()));
      if (!bytes) return bytes.error();
      if (auto ok = parse_unit(parser, *unit, *bytes, first_frame, rigs); !ok) {
        return ok.error();
      }
    }
    end_ = unit->end();
    const auto next = unit_after(*unit, parser.slice_type());
    if (!next) return next.error();
    unit = *next;
  }
  return parser.finish();
}

std::optional<RawAccessUnit> AccessUnitReader::collect(const UnitHeader& gof_unit,
                                                       std::uint32_t first_frame,
                                                       std::uint64_t max_memory_bytes) {
  RawAccessUnit coded;
  std::uint64_t num_bytes = 0;
  for (std::optional<UnitHeader> unit = gof_unit; unit;) {
    num_bytes += unit->size;
    if (num_bytes > max_memory_bytes) return std::nullopt;
    auto payload = units_.payload(*unit);
    if (!payload) return std::nullopt;
    if (coded.units.empty()) {
      BitReader r = units_.bits(*unit, *payload);
      coded.gof = parse_gof_header(r, context_.header, first_frame);
      if (r.error()) return std::nullopt;
    }
    coded.units.push_back({*unit, std::move(*payload)});
    const auto next = unit_after(*unit, slice_type(coded.gof.kind));
    if (!next) return std::nullopt;
    unit = *next;
  }
  return coded;
}

Result<AccessUnit> AccessUnitReader::parse(const RawAccessUnit& coded, const RigSlots& rigs,
                                           const SliceCut& cut,
                                           std::uint64_t max_memory_bytes) const {
  const MemoryLimit memory = limit_ahead(max_memory_bytes);
  const std::uint64_t of_rigs = memory_of_rigs(rigs);
  AccessUnitParser parser(context_, memory, cut);
  for (const auto& [unit, payload] : coded.units) {
    const std::uint64_t taken_bytes = std::max(of_rigs, parser.memory_bytes());
    if (auto ok = check_fits(unit, taken_bytes, memory); !ok) return ok.error();
    if (auto ok = parse_unit(parser, unit, payload, coded.gof.first_frame, rigs); !ok)
      return ok.error();
  }
  return parser.finish();
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

Result<bool> AccessUnitReader::parse_unit(AccessUnitParser& parser, const UnitHeader& unit,
                                          const Vector<std::uint8_t>& payload,
                                          std::uint32_t first_frame,
                                          const RigSlots& rigs) const {
  BitReader r = units_.bits(unit, payload);
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

Result<ParsedRig> AccessUnitReader::read_rig(const UnitHeader& rig_unit, const RigSlots& rigs) {
  RigParser parser(context_, memory_limit(), cut_);
  const std::uint64_t of_rigs = memory_of_rigs(rigs);
  for (std::optional<UnitHeader> unit = rig_unit; unit;) {
    const auto dropped = is_dropped(*unit, parser);
    if (!dropped) return dropped.error();
    if (!*dropped) {
      const auto bytes = payload(*unit, std::max(of_rigs, parser.memory_bytes()));
      if (!bytes) return bytes.error();
      if (auto ok = parse_unit(parser, *unit, *bytes, rigs); !ok) return ok.error();
    }
    end_ = unit->end();
    const auto next = slice_after(*unit);
    if (!next) return next.error();
    unit = *next;
  }
  return parser.finish();
}

std::optional<Vector<RawUnit>> AccessUnitReader::collect_rig(const UnitHeader& rig_unit,
                                                             std::uint64_t max_memory_bytes) {
  Vector<RawUnit> coded;
  std::uint64_t num_bytes = 0;
  for (std::optional<UnitHeader> unit = rig_unit; unit;) {
    num_bytes += unit->size;
    if (num_bytes > max_memory_bytes) return std::nullopt;
    auto payload = units_.payload(*unit);
    if (!payload) return std::nullopt;
    coded.push_back({*unit, std::move(*payload)});
    const auto next = slice_after(*unit);
    if (!next) return std::nullopt;
    unit = *next;
  }
  return coded;
}

Result<ParsedRig> AccessUnitReader::parse_rig(const Vector<RawUnit>& coded,
                                              const RigSlots& rigs, const SliceCut& cut,
                                              std::uint64_t max_memory_bytes) const {
  const MemoryLimit memory = limit_ahead(max_memory_bytes);
  const std::uint64_t of_rigs = memory_of_rigs(rigs);
  RigParser parser(context_, memory, cut);
  for (const auto& [unit, payload] : coded) {
    const std::uint64_t taken_bytes = std::max(of_rigs, parser.memory_bytes());
    if (auto ok = check_fits(unit, taken_bytes, memory); !ok) return ok.error();
    if (auto ok = parse_unit(parser, unit, payload, rigs); !ok) return ok.error();
  }
  return parser.finish();
}

Result<bool> AccessUnitReader::parse_unit(RigParser& parser, const UnitHeader& unit,
                                          const Vector<std::uint8_t>& payload,
                                          const RigSlots& rigs) const {
  BitReader r = units_.bits(unit, payload);
  const std::uint64_t unit_bytes = unit.end() - unit.offset;
  return unit.type() == UnitType::kRig ? parser.rig(r, rigs, unit_bytes)
                                       : parser.slice(r, unit.offset * 8, unit_bytes);
}

Result<std::optional<UnitHeader>> AccessUnitReader::slice_after(const UnitHeader& unit) {
  const auto next = units_.header_at(unit.end());
  if (!next) return next.error();
  const bool follows = next->type() == UnitType::kSlice;
  return follows ? std::optional(*next) : std::nullopt;
}

// Returns the unit that follows `unit` in the same access unit; none if `unit` is the last one.
Result<std::optional<UnitHeader>> AccessUnitReader::unit_after(const UnitHeader& unit,
                                                               std::optional<UnitType> slice) {
  using Next = std::optional<UnitHeader>;
  const bool may_follow = slice || wants_hash_;
  if (unit.type() == UnitType::kGofHash || !may_follow || !units_.goes_on_after(unit.end())) {
    return Next();
  }
  const auto next = units_.header_at(unit.end());
  if (!next) return next.error();
  const bool is_frames = slice == UnitType::kFrame;
  const bool may_have_hash =
      wants_hash_ && !(is_frames && is_live(context_.header, GofKind::kInter));
  const bool follows = (slice && next->type() == *slice) ||
                       (may_have_hash && next->type() == UnitType::kGofHash);
  return follows ? Next(*next) : Next();
}

}  // namespace rlpc
