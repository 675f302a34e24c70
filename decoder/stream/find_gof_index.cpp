#include "decoder/stream/find_gof_index.h"

#include "common/syntax/stream_format.h"
#include "decoder/parse/sequence/parse_end_of_sequence.h"

namespace rlpc {

Result<GofIndex> find_gof_index(UnitReader& units, std::uint64_t first_unit,
                                const SequenceHeader& header) {
  constexpr std::uint64_t kEndBytes = kUnitHeaderBytes + 4 + kUnitCrcBytes;
  const GofIndex none;
  if (units.size() < first_unit + kEndBytes) return none;
  const auto end = units.header_at(units.size() - kEndBytes);
  if (!end || end->type() != UnitType::kEndOfSequence) return none;
  const auto end_payload = units.payload(*end);
  if (!end_payload) return end_payload.error();
  BitReader end_bits = units.bits(*end, *end_payload);
  const std::uint32_t distance = parse_end_of_sequence(end_bits);
  if (distance == 0) return none;
  const Error wrong{Errc::kInvalid, "R-END-03", "index_distance", end->payload_offset() * 8};
  if (distance > end->offset) return wrong;
  const auto unit = units.header_at(end->offset - distance);
  if (!unit) return unit.error();
  if (unit->type() != UnitType::kGofIndex || unit->end() != end->offset) return wrong;
  const auto payload = units.payload(*unit);
  if (!payload) return payload.error();
  BitReader r = units.bits(*unit, *payload);
  return parse_gof_index(r, header);
}

}  // namespace rlpc
