#include "decoder/codec/units/find_gof_index.h"

#include "common/codec/syntax/stream_format.h"
#include "decoder/codec/parse/sequence/parse_end_of_sequence.h"

namespace rlpc {

Result<GofIndex> find_gof_index(UnitReader& units, std::uint64_t first_unit,
                                const SequenceHeader& header) {
  const std::uint64_t end_bytes =
      kUnitHeaderBytes + std::uint64_t{end_of_sequence_bytes(header)} + kUnitCrcBytes;
  const GofIndex none;
  if (units.size() < first_unit + end_bytes) return none;
  const auto end = units.header_at(units.size() - end_bytes);
  if (!end && end.error().code == Errc::kIo) return end.error();
  if (!end || end->type() != UnitType::kEndOfSequence) return none;
  const auto end_payload = units.payload(*end);
  if (!end_payload) return end_payload.error();
  BitReader end_bits = units.bits(*end, *end_payload);
  const auto [distance, num_frames] = parse_end_of_sequence(end_bits, header);
  if (end_bits.error()) return *end_bits.error();
  if (distance == 0) return none;
  const Error wrong{Errc::kInvalid, "R-END-03", "index_distance", end->payload_offset() * 8};
  if (distance > end->offset) return wrong;
  const auto unit = units.header_at(end->offset - distance);
  if (!unit) return unit.error();
  if (unit->type() != UnitType::kGofIndex || unit->end() != end->offset) return wrong;
  const auto payload = units.payload(*unit);
  if (!payload) return payload.error();
  BitReader r = units.bits(*unit, *payload);
  SequenceHeader whole = header;
  whole.num_frames = num_frames;
  return parse_gof_index(r, whole);
}

}  // namespace rlpc
