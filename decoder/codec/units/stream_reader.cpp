#include "decoder/codec/units/stream_reader.h"

#include <algorithm>
#include <utility>

#include "common/codec/syntax/stream_format.h"
#include "decoder/codec/kinds/inter/parse/parse_inter_gof.h"
#include "decoder/codec/parse/memory_estimate.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "decoder/codec/parse/sequence/parse_clip_table.h"
#include "decoder/codec/parse/sequence/parse_connectivity.h"
#include "decoder/codec/parse/sequence/parse_end_of_sequence.h"
#include "decoder/codec/parse/sequence/parse_metadata.h"
#include "decoder/codec/parse/sequence/parse_sequence_header.h"
#include "decoder/codec/parse/sequence/parse_vertex_order.h"
#include "decoder/codec/units/exceeded_limit.h"
#include "decoder/codec/units/find_gof_index.h"
#include "decoder/codec/units/unit_cursor.h"

namespace rlpc {
namespace {

std::uint64_t bytes_of(const Vector<Clip>& clips) {
  std::uint64_t bytes = clips.capacity() * sizeof(Clip);
  for (const Clip& clip : clips) bytes += clip.name.capacity();
  return bytes;
}

}  // namespace

StreamReader::StreamReader(std::unique_ptr<ByteSource> source, const DecoderOptions& options)
    : options_{options.limits, options.coarse_layers != SliceCut::kAll,
               options.skip_damaged_units},
      units_(std::move(source), options.trace, options.limits.max_memory_bytes),
      access_units_(units_, context_, options),
      rigs_(units_, access_units_) {}

Result<bool> StreamReader::open() {
  if (auto ok = units_.stream_header(); !ok) return ok;
  if (auto ok = read_sequence_header(); !ok) return ok;
  bool have_connectivity = false;
  for (;;) {
    const auto unit = units_.header_at(place_.offset);
    if (!unit) return unit.error();
    if (unit->type() == UnitType::kConnectivity && !have_connectivity) {
      if (auto ok = read_connectivity(*unit); !ok) return ok;
      have_connectivity = true;
    } else if (unit->type() == UnitType::kVertexOrder && have_connectivity &&
               lead_.vertex_order.empty()) {
      if (auto ok = read_vertex_order(*unit); !ok) return ok;
    } else if (starts_gofs(*unit) && have_connectivity) {
      return true;
    } else {
      const auto is_intact = read_ancillary(*unit);
      if (!is_intact) return is_intact;
      if (*is_intact && have_connectivity) keep_place_of(*unit);
    }
    place_.offset = unit->end();
  }
}

// 6.1 StartsGofs( )
bool StreamReader::starts_gofs(const UnitHeader& unit) const {
  return unit.type() == UnitType::kGof ||
         (unit.type() == UnitType::kRig && units_.version_minor() >= 2);
}

// 6.3: reads the first unit.
Result<bool> StreamReader::read_sequence_header() {
  const auto unit = units_.header_at(place_.offset);
  if (!unit) return unit.error();
  if (unit->type() != UnitType::kSequenceHeader)
    return misplaced(*unit, units_.version_minor());
  const auto payload = units_.payload(*unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(*unit, *payload);
  SequenceHeaderPlaces places;
  const auto header = parse_sequence_header(r, units_.version_minor(), &places);
  if (!header) return header.error();
  context_.header = *header;
  units_.set_max_unit_bytes(context_.header.level().max_unit_bytes);
  place_.offset = unit->end();
  return check_limits(places);
}

Result<bool> StreamReader::check_limits(const SequenceHeaderPlaces& places) {
  const SequenceHeader& header = context_.header;
  const std::uint64_t bytes = memory_of_stream(header, kFramesHeld) +
                              (options_.is_coarse ? memory_of_coarse_mesh(header) : 0);
  if (const auto error = find_exceeded_limit(header, places, options_.limits, bytes))
    return *error;
  bytes_in_use_ = bytes;
  units_.set_bytes_in_use(bytes);
  access_units_.set_bytes_in_use(bytes);
  return true;
}

Result<bool> StreamReader::read_connectivity(const UnitHeader& unit) {
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  auto triangles =
      parse_connectivity(r, context_.header.num_vertices, context_.header.num_triangles);
  if (!triangles) return triangles.error();
  lead_.triangles = std::move(*triangles);
  context_.set_connectivity(lead_.triangles);
  return true;
}

Result<bool> StreamReader::read_vertex_order(const UnitHeader& unit) {
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  auto order = parse_vertex_order(r, context_.header.num_vertices);
  if (!order) return order.error();
  lead_.vertex_order = std::move(*order);
  for (Triangle& t : lead_.triangles) {
    for (std::uint32_t& v : t) v = lead_.vertex_order[v];
  }
  return true;
}

// Keeps the place of the first unit of each type, as a stream has at most one.
void StreamReader::keep_place_of(const UnitHeader& unit) {
  if (unit.type() == UnitType::kAttributes && !lead_.attribute_unit)
    lead_.attribute_unit = unit;
  if (unit.type() == UnitType::kAsset && !lead_.asset_unit) lead_.asset_unit = unit;
}

// Reads a unit that a decoder may skip: checks its CRC, and keeps metadata and clips. Returns
// false if it is damaged and ignored.
Result<bool> StreamReader::read_ancillary(const UnitHeader& unit) {
  auto ok = parse_ancillary(unit);
  if (ok || !options_.skips_damaged_units || !unit.ancillary() ||
      ok.error().code != Errc::kInvalid) {
    return ok;
  }
  const std::uint64_t last =
      lead_.damaged_units.empty() ? 0 : lead_.damaged_units.back().bit_pos;
  if (ok.error().bit_pos > last)
    lead_.damaged_units.push_back(ok.error());  // once, not again after a seek
  return false;
}

Result<bool> StreamReader::parse_ancillary(const UnitHeader& unit) {
  if (!unit.ancillary()) return misplaced(unit, units_.version_minor());
  if (unit.type() == UnitType::kMetadata) return read_metadata(unit);
  if (unit.type() == UnitType::kClipTable) return read_clip_table(unit);
  return units_.skip(unit);
}

void StreamReader::count_kept(std::uint64_t before, std::uint64_t now) {
  bytes_in_use_ += now - before;
  access_units_.set_bytes_in_use(bytes_in_use_);
  units_.set_bytes_in_use(access_units_.memory_limit().bytes_in_use);
}

Result<bool> StreamReader::read_metadata(const UnitHeader& unit) {
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  auto json = parse_metadata(r, access_units_.memory_limit());
  if (!json) return json.error();
  count_kept(lead_.metadata.size(), json->size());
  lead_.metadata = std::move(*json);
  return true;
}

Result<bool> StreamReader::read_clip_table(const UnitHeader& unit) {
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  auto clips = parse_clip_table(r, context_.header.num_frames, access_units_.memory_limit());
  if (!clips) return clips.error();
  count_kept(bytes_of(lead_.clips), bytes_of(*clips));
  lead_.clips = std::move(*clips);
  return true;
}

Result<std::optional<UnitHeader>> StreamReader::find_gof(Rigs rigs) {
  for (;;) {
    const auto unit = units_.header_at(place_.offset);
    if (!unit) return unit.error();
    if (unit->type() == UnitType::kGof) {
      if (place_.next_first_frame == context_.header.num_frames) {
        return Error{Errc::kInvalid, "R-END-01", "unit_type", unit->offset * 8};
      }
      return std::optional(*unit);
    }
    if (unit->type() == UnitType::kEndOfSequence) {
      if (const auto ok = check_end(*unit); !ok) return ok.error();
      return std::optional<UnitHeader>();
    }
    if (starts_gofs(*unit)) {
      const auto end = rigs == Rigs::kSkip ? rigs_.skip(*unit) : rigs_.read(*unit);
      if (!end) return end.error();
      place_.offset = *end;
      continue;
    }
    if (const auto ok = read_ancillary(*unit); !ok) return ok.error();
    place_.offset = unit->end();
  }
}

// 6.8 end_of_sequence( )
Result<bool> StreamReader::check_end(const UnitHeader& unit) {
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  const std::uint32_t num_frames = parse_end_of_sequence(r, context_.header).num_frames;
  units_.flush_trace();
  if (r.error()) return *r.error();
  if (place_.next_first_frame != num_frames) {
    return Error{Errc::kInvalid, "R-END-01", "unit_type", unit.offset * 8};
  }
  if (units_.goes_on_after(unit.end())) {
    return Error{Errc::kInvalid, "R-END-02", "end_of_sequence", unit.end() * 8};
  }
  place_.ended = true;
  return true;
}

Result<std::optional<std::uint32_t>> StreamReader::skip_damage() {
  constexpr std::uint32_t kEnough = 8;  // a code of at most 63 bits
  for (bool is_first = true;; is_first = false) {
    const auto unit = units_.header_at(place_.offset);
    if (!unit) return unit.error();
    if (unit->type() == UnitType::kEndOfSequence) return std::optional<std::uint32_t>();
    // The GOF with the error begins here, if its GOF unit could be read.
    if (unit->type() == UnitType::kGof && !is_first) {
      const auto bytes = units_.payload_start(*unit, kEnough);
      if (!bytes) return bytes.error();
      BitReader r = units_.bits(*unit, *bytes);
      const std::int64_t highest = std::int64_t{context_.header.num_frames} - 1;
      const std::uint32_t first_frame =
          parse_first_frame(r, {place_.next_first_frame, highest});
      if (r.error()) return *r.error();
      place_.next_first_frame = first_frame;
      return std::optional(first_frame);
    }
    if (unit->type() == UnitType::kRig && !is_first) {
      const auto end = rigs_.skip(*unit);
      if (!end) return end.error();
      place_.offset = *end;
    } else {
      place_.offset = unit->end();
    }
  }
}

std::uint32_t StreamReader::find_num_frames() {
  const SequenceHeader& header = context_.header;
  const std::uint32_t payload_bytes = end_of_sequence_bytes(header);
  const std::uint64_t end_bytes =
      kUnitHeaderBytes + std::uint64_t{payload_bytes} + kUnitCrcBytes;
  if (!header.open_end_flag || units_.size() < place_.offset + end_bytes)
    return header.num_frames;
  const auto unit = units_.header_at(units_.size() - end_bytes);
  if (!unit || unit->type() != UnitType::kEndOfSequence) return header.num_frames;
  const auto bytes = units_.payload_start(*unit, payload_bytes);
  if (!bytes) return header.num_frames;
  BitReader r(*bytes);
  const std::uint32_t num_frames = parse_end_of_sequence(r, header).num_frames;
  return r.error() ? header.num_frames : num_frames;
}

Result<AccessUnit> StreamReader::read(const UnitHeader& gof_unit) {
  const auto rigs = rigs_.at(gof_unit.offset);
  if (!rigs) return rigs.error();
  auto access_unit = access_units_.read(gof_unit, place_.next_first_frame, *rigs);
  if (access_unit) {
    go_past(gof_unit, access_unit->header().num_frames, access_units_.end());
  }
  return access_unit;
}

void StreamReader::go_past(const UnitHeader& gof_unit, std::uint32_t num_frames,
                           std::uint64_t end) {
  remember_gof(gof_unit);
  place_.next_first_frame += num_frames;
  place_.offset = end;
}

Result<std::optional<AccessUnit>> StreamReader::next() {
  const auto unit = find_gof();
  if (!unit) return unit.error();
  if (!*unit) return std::optional<AccessUnit>();
  auto access_unit = read(**unit);
  if (!access_unit) return access_unit.error();
  return std::optional(std::move(*access_unit));
}

Result<GofHeader> StreamReader::gof_header(const UnitHeader& unit) {
  constexpr std::uint32_t kEnough = 17;  // two codes of at most 63 bits, and gof_kind
  const auto bytes = units_.payload_start(unit, kEnough);
  if (!bytes) return bytes.error();
  BitReader r = units_.bits(unit, *bytes);
  const GofHeader header = parse_gof_header(r, context_.header, place_.next_first_frame);
  if (r.error()) return *r.error();
  return header;
}

// Goes past the slice or frame units of a GOF. A frame unit may say that the GOF ends early.
Result<bool> StreamReader::skip_slices(const UnitHeader& gof_unit, UnitType type,
                                       std::uint32_t first_frame) {
  UnitCursor cursor(units_, gof_unit);
  for (;;) {
    place_.offset = cursor.end();
    const auto more = cursor.advance({type});
    if (!more || !*more) return more;
    if (type != UnitType::kFrame || !context_.header.open_end_flag) continue;
    const auto end = gof_end(cursor.unit());
    if (!end) return end.error();
    if (*end) place_.next_first_frame = first_frame + **end;
  }
}

// Returns the number of frames of the GOF, if the frame unit ends it.
Result<std::optional<std::uint32_t>> StreamReader::gof_end(const UnitHeader& unit) {
  constexpr std::uint32_t kEnough = 9;  // a code of at most 63 bits, and gof_end_flag
  const auto bytes = units_.payload_start(unit, kEnough);
  if (!bytes) return bytes.error();
  BitReader r = units_.bits(unit, *bytes);
  const FrameUnitStart start = parse_frame_unit_start(r, context_.header, kMaxFrames);
  if (r.error()) return *r.error();
  return start.gof_end_flag ? std::optional(start.frame_idx) : std::nullopt;
}

void StreamReader::remember_gof(const UnitHeader& unit) {
  if (gofs_.empty() || gofs_.back().first_frame < place_.next_first_frame) {
    gofs_.push_back({unit.offset, place_.next_first_frame});
  }
}

Result<bool> StreamReader::seek(std::uint32_t frame) {
  const auto gof = pass_gofs_to(frame);
  if (!gof) return gof.error();
  go_to(gof->offset, gof->first_frame);
  return true;
}

Result<GofPlace> StreamReader::locate(std::uint32_t frame) {
  const Place here = place();
  const auto gof = pass_gofs_to(frame);
  return_to(here);
  return gof;
}

void StreamReader::return_to(const Place& place) { place_ = place; }

void StreamReader::go_to(std::uint64_t offset, std::uint32_t first_frame) {
  place_ = {offset, first_frame, false};
}

// Goes past the GOF with the frame, and returns its place.
Result<GofPlace> StreamReader::pass_gofs_to(std::uint32_t frame) {
  place_.ended = false;
  const bool met = !gofs_.empty() && frame < place_.next_first_frame;
  if (!met && !index_tried_) {
    auto index = find_gof_index(units_, place_.offset, context_.header);
    // The next GOF needs no index, and the end of the stream may still be missing.
    const bool can_wait =
        !index && index.error().code == Errc::kIo && frame == place_.next_first_frame;
    if (!index && !can_wait) return index.error();
    if (index) {
      index_tried_ = true;
      rigs_.add(index->rigs);
      if (!index->gofs.empty()) gofs_ = std::move(index->gofs);
    }
  }
  const auto after =
      std::upper_bound(gofs_.begin(), gofs_.end(), frame,
                       [](std::uint32_t f, const GofLocation& g) { return f < g.first_frame; });
  if (after != gofs_.begin()) {
    place_.offset = std::prev(after)->offset;
    place_.next_first_frame = std::prev(after)->first_frame;
  }
  // Skips GOFs, reading only their headers.
  for (;;) {
    const auto unit = find_gof(Rigs::kSkip);
    if (!unit) return unit.error();
    if (!*unit) return Error{Errc::kInvalid, "R-END-01", "unit_type", place_.offset * 8};
    const auto gof = gof_header(**unit);
    if (!gof) return gof.error();
    const std::uint64_t start = place_.offset;
    const std::uint32_t first_frame = place_.next_first_frame;
    go_past(**unit, gof->num_frames, (*unit)->end());
    if (const auto type = slice_type(gof->kind)) {
      if (auto ok = skip_slices(**unit, *type, first_frame); !ok) return ok.error();
    }
    if (frame < place_.next_first_frame)
      return GofPlace{start, first_frame, place_.next_first_frame - first_frame};
  }
}

}  // namespace rlpc
