// Contents of units: 6.3 to 6.13, and the hash check of 8.6.2.
#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "common/codec/bits/crc32.h"
#include "common/codec/syntax/stream_format.h"
#include "common/json/json_text.h"
#include "conformance/rlpcval/validator_elements.h"
#include "conformance/rlpcval/validator_gofs.h"
#include "conformance/rlpcval/validator_stream.h"
#include "decoder/codec/gofs/make_recon.h"
#include "decoder/codec/parse/memory_estimate.h"
#include "decoder/codec/parse/parse_gof_hash.h"
#include "decoder/codec/parse/sequence/parse_clip_table.h"
#include "decoder/codec/parse/sequence/parse_connectivity.h"
#include "decoder/codec/parse/sequence/parse_end_of_sequence.h"
#include "decoder/codec/parse/sequence/parse_metadata.h"
#include "decoder/codec/parse/sequence/parse_vertex_order.h"
#include "decoder/codec/units/exceeded_limit.h"
#include "decoder/codec/units/stream_reader.h"

namespace rlpc {
namespace {

BitReader bits_of(const UnitHeader& unit, const std::vector<std::uint8_t>& payload) {
  return BitReader(payload, unit.payload_offset() * 8);
}

}  // namespace

// 6.2 unit_payload( ). `sound`: the CRC of the unit holds.
void StreamValidator::read_payload(const UnitHeader& unit, bool sound) {
  if (unit.ancillary() && !is_known_ancillary(unit.type())) return;
  if (unit.type() == UnitType::kGof) begin_gof(unit);
  if (unit.type() == UnitType::kRig) begin_rig(unit);
  const auto payload = units_.payload(unit);
  if (!payload && unit.type() == UnitType::kRig) doubt_rigs();
  if (!payload) return;
  findings_.suspect(!sound);
  switch (unit.type()) {
    case UnitType::kSequenceHeader:
      return sequence_header(unit, *payload);
    case UnitType::kConnectivity:
      return connectivity(unit, *payload);
    case UnitType::kVertexOrder:
      return vertex_order(unit, *payload);
    case UnitType::kGof:
      return gof(unit, *payload);
    case UnitType::kSlice:
    case UnitType::kFrame:
      return slice(unit, *payload);
    case UnitType::kRig:
      return rig(unit, *payload);
    case UnitType::kEndOfSequence:
      return end_of_sequence(unit, *payload);
    case UnitType::kGofIndex:
      return gof_index(unit, *payload);
    case UnitType::kGofHash:
      return gof_hash(unit, *payload);
    case UnitType::kMetadata:
      return metadata(unit, *payload);
    case UnitType::kClipTable:
      return clip_table(unit, *payload);
    case UnitType::kAttributes:
      return attributes(unit, *payload);
    case UnitType::kAsset:
      return asset(unit, *payload);
  }
}

bool StreamValidator::can_read() {
  findings_.suspect(findings_.suspect() || lead_.header_suspect);
  if (lead_.header && lead_.header->usable && lead_.within_limits) return true;
  report_.complete = false;
  return false;
}

// 6.3 sequence_header( )
void StreamValidator::sequence_header(const UnitHeader& unit, const Payload& payload) {
  if (lead_.header) return;  // in the wrong place, already reported
  ElementReader r(unit, payload, findings_);
  lead_.header = check_sequence_header(r, units_.version_minor());
  lead_.header_bit_pos = unit.payload_offset() * 8;
  lead_.header_suspect = findings_.suspect() || r.failures() > 0;
  if (!lead_.header->supported) unsupported_ = true;
  if (!lead_.header->supported && r.failures() == 0) {
    findings_.in_unit(std::nullopt);
    findings_.error(unsupported_minor_version(),
                    "version 1." + std::to_string(units_.version_minor()) +
                        " is not the first that has the profile of the stream, " +
                        std::to_string(lead_.header->header.profile_idc));
  }
  if (!lead_.header->usable) return;
  units_.set_max_unit_bytes(lead_.header->header.level().max_unit_bytes);
  report_.header = lead_.header->header;
  check_limits();
}

void StreamValidator::check_limits() {
  const SequenceHeader& header = lead_.header->header;
  const auto error = find_exceeded_limit(header, lead_.header->places, options_.limits,
                                         memory_of_stream(header, kFramesHeld));
  lead_.within_limits = !error;
  if (error) findings_.error(*error);
}

MemoryLimit StreamValidator::memory_limit() const {
  const std::uint64_t max_bytes = options_.limits.max_memory_bytes;
  if (!lead_.header) return {max_bytes, 0};
  return {max_bytes, memory_of_stream(lead_.header->header, kFramesHeld)};
}

// 6.4 Connectivity
void StreamValidator::connectivity(const UnitHeader& unit, const Payload& payload) {
  if (lead_.has_connectivity || !can_read()) return;
  lead_.connectivity_suspect = findings_.suspect();
  const SequenceHeader& h = lead_.header->header;
  BitReader r = bits_of(unit, payload);
  const auto triangles = parse_connectivity(r, h.num_vertices, h.num_triangles);
  if (!triangles) {
    findings_.error(triangles.error());
    report_.complete = false;
    return;
  }
  lead_.context.header = h;
  lead_.context.set_connectivity(*triangles);
  lead_.triangles = *triangles;
  lead_.has_connectivity = true;
  recons_.emplace(lead_.context);
}

// 6.6 vertex_order( )
void StreamValidator::vertex_order(const UnitHeader& unit, const Payload& payload) {
  if (lead_.has_vertex_order || !can_read()) return;
  BitReader r = bits_of(unit, payload);
  const auto order = parse_vertex_order(r, lead_.header->header.num_vertices);
  lead_.has_vertex_order = static_cast<bool>(order);
  if (!order) findings_.error(order.error());
}

// Records what is known of a GOF before reading it.
void StreamValidator::begin_gof(const UnitHeader& unit) {
  index_.gofs.push_back({unit.offset, 0});
  gof_ = {};
  gof_.unit = unit;
  gof_.place = {report_.units, unit.type_byte, unit.offset};
  gof_.may_have_slices = gof_.may_have_frames = true;
  gof_.expected_first_frame = std::exchange(next_frame_, std::nullopt);
}

// 6.5 gof( )
void StreamValidator::gof(const UnitHeader& unit, const Payload& payload) {
  if (!can_read()) return;
  const bool damaged = findings_.suspect();
  findings_.suspect(damaged || frames_suspect_);
  // A surplus GOF has been reported; it may be a copy of any other.
  const bool surplus = gof_.expected_first_frame == lead_.header->header.num_frames;
  ElementReader r(unit, payload, findings_);
  const std::uint32_t num_layers =
      lead_.context.meshes ? (*lead_.context.meshes)[Prediction::kLayers].num_layers() : 0;
  const GofHeaderCheck header =
      check_gof_header(r, lead_.header->header,
                       surplus ? std::nullopt : gof_.expected_first_frame, num_layers, rigs_);
  const bool may_be_any = damaged || !header.kind;
  gof_.may_have_slices = may_be_any || slice_type(*header.kind) == UnitType::kSlice;
  gof_.may_have_frames = may_be_any || slice_type(*header.kind) == UnitType::kFrame;
  gof_.unit_counts = header.units;
  frames_suspect_ = r.failures() > 0 || damaged || surplus;
  gof_.num_frames = header.num_frames;
  if (header.num_frames > 0) {
    index_.gofs.back().first_frame = header.first_frame;
    ++index_.known_first_frames;
    next_frame_ = header.first_frame + header.num_frames;
  }
  if (surplus) next_frame_ = gof_.expected_first_frame;
  gof_.suspect = damaged || lead_.connectivity_suspect || header.rig_suspect;
  findings_.suspect(gof_.suspect);
  gof_body(unit, payload, header);
}

// 6.5 clusters_of_gof( ), 6.11 bones_of_gof( ), 6.13.1 tracks_of_gof( ), 6.14 frames_of_gof( )
void StreamValidator::gof_body(const UnitHeader& unit, const Payload& payload,
                               const GofHeaderCheck& header) {
  const bool on_grid = header.kind == GofKind::kCluster || lead_.header->positions;
  if (!header.section_readable || !lead_.has_connectivity || !on_grid) {
    report_.complete = false;
    return;
  }
  gof_.parser = std::make_unique<AccessUnitParser>(lead_.context, memory_limit());
  BitReader r = bits_of(unit, payload);
  if (const auto read =
          gof_.parser->gof(r, header.first_frame, slots_of(rigs_), unit.end() - unit.offset);
      !read) {
    findings_.error(read.error());
    report_.complete = false;
    gof_.parser.reset();
  } else if (!has_slices(gof_.parser->kind())) {
    end_slices();
  }
}

// 6.12 slice_unit( ), 6.14.2 frame_unit( )
void StreamValidator::slice(const UnitHeader& unit, const Payload& payload) {
  if (!can_read()) return;
  if (rig_.unit) return slice_of(rig_, unit, payload);
  slice_of(gof_, unit, payload);
}

template <class Parser>
void StreamValidator::slice_of(Current<Parser>& current, const UnitHeader& unit,
                               const Payload& payload) {
  const bool is_frame = unit.type() == UnitType::kFrame;
  if (!current.unit || !is_known(current.unit_counts) ||
      is_frame != std::holds_alternative<FrameCounts>(current.unit_counts)) {
    report_.complete = false;
    return;
  }
  current.suspect = current.suspect || findings_.suspect();
  findings_.suspect(current.suspect);
  ElementReader header(unit, payload, findings_);
  bool read = check_unit_header(header, lead_.header->header, current.unit_counts);
  if (read && current.parser) {
    BitReader r = bits_of(unit, payload);
    const auto result = current.parser->slice(r, unit.offset * 8, unit.end() - unit.offset);
    if (!result) findings_.error(result.error());
    read = static_cast<bool>(result);
  }
  needed_.max_unit_bytes = std::max<std::uint64_t>(needed_.max_unit_bytes, unit.size);
  if (read) return;
  // The contents of later slices depend on it.
  report_.complete = false;
  current.suspect = true;
  current.parser.reset();
}

void StreamValidator::end_slices() {
  end_gof();
  end_rig();
}

// 8.14.1: slices at the end of a GOF can be absent.
void StreamValidator::end_gof() {
  if (!gof_.parser) return;
  gof_.access_unit = gof_.parser->finish();
  gof_.parser.reset();
  ++report_.gofs;
  report_.frames += gof_.access_unit->header().num_frames;
  // It may have ended early.
  if (next_frame_) *next_frame_ -= gof_.num_frames - gof_.access_unit->header().num_frames;
  gof_.num_frames = gof_.access_unit->header().num_frames;
  findings_.in_unit(gof_.place);
  needed_.max_unit_bytes = std::max<std::uint64_t>(needed_.max_unit_bytes, gof_.unit->size);
  warn_of_gof(*gof_.access_unit, lead_.context, slots_of(rigs_),
              gof_.unit->payload_offset() * 8, findings_, needed_);
  if (const auto* skinned = std::get_if<SkinnedGof>(&gof_.access_unit->gof)) {
    use_rig(*skinned);
  }
  gof_.frames_due = lead_.header->positions;
  // Frames of a stream that is still being made are decoded before anything else is read.
  if (is_live(lead_.header->header, gof_.access_unit->header().kind)) check_due_frames();
}

// 6.1 access_unit( ): a GOF hash unit is read before the frames are decoded, so its own errors
// come first.
void StreamValidator::check_due_frames() {
  if (!std::exchange(gof_.frames_due, false)) return;
  findings_.in_unit(gof_.place);
  compare_frame_crcs(*gof_.access_unit);
  if (index_.gofs.size() == 1 && !gap_) compare_first_frame(*gof_.access_unit);
}

// 6.7 gof_hash( )
void StreamValidator::gof_hash(const UnitHeader& unit, const Payload& payload) {
  if (!gof_.unit) {
    // After a gap, the GOF may have been lost.
    if (previous_) {
      findings_.unchecked("R-HSH-03", "unit_type", unit.offset * 8,
                          "no GOF unit, and no slice of one, ends where it starts");
    }
    return;
  }
  if (gof_.num_frames == 0) {
    report_.complete = false;
    return;
  }
  findings_.suspect(findings_.suspect() || gof_.suspect);
  BitReader r = bits_of(unit, payload);
  if (gof_.access_unit && is_live(lead_.header->header, gof_.access_unit->header().kind)) {
    findings_.unchecked("R-HSH-03", "unit_type", unit.offset * 8,
                        std::string(kind_name(gof_.access_unit->header().kind)) +
                            " GOFs of an open-ended stream have hashes in their frame units");
    return;
  }
  const auto hash = parse_gof_hash(r, gof_.num_frames);
  if (!hash) findings_.error(hash.error());
  check_due_frames();
  findings_.in_unit(FindingUnit{report_.units, unit.type_byte, unit.offset});
  if (!hash) return;
  if (gof_.access_unit && lead_.header->positions) {
    compare_hashes(unit, *hash);
  } else {
    report_.complete = false;
  }
}

// 8.19.1 CheckFrameCrc( f )
void StreamValidator::compare_frame_crcs(const AccessUnit& access_unit) {
  const FrameCrcs crcs = access_unit.frame_crcs();
  if (crcs.empty()) return;
  const auto recon = make_recon(access_unit, lead_.context, *recons_);
  std::vector<std::int32_t> positions(3 * std::size_t{lead_.header->header.num_vertices});
  const auto hashed = static_cast<std::uint32_t>(
      std::count_if(crcs.begin(), crcs.end(), [](const auto& crc) { return crc.has_value(); }));
  if (hashed == crcs.size()) ++report_.gofs_of_hashed_frames;
  for (std::uint32_t f = 0; f < crcs.size(); ++f) {
    if (!crcs[f]) continue;
    recon->frame(f, positions);
    const std::uint32_t crc = crc32_of_positions(positions);
    if (crc == crcs[f]->crc) continue;
    const std::uint32_t frame = access_unit.header().first_frame + f;
    return findings_.error({Errc::kInvalid, "R-HSH-02", "frame_crc", crcs[f]->bit_pos},
                           "of frame " + std::to_string(frame) + ": frame_crc is " +
                               hex(crcs[f]->crc) + ", the decoded positions give " + hex(crc));
  }
  if (is_live(lead_.header->header, access_unit.header().kind)) report_.hashed_frames += hashed;
}

// 8.6.2 Hash check
void StreamValidator::compare_hashes(const UnitHeader& unit, const GofHash& hash) {
  const auto recon = make_recon(*gof_.access_unit, lead_.context, *recons_);
  const bool per_frame = hash.per_frame_flag;
  std::vector<std::int32_t> positions(3 * std::size_t{lead_.header->header.num_vertices});
  std::uint32_t crc = 0;
  std::uint32_t wrong_frames = 0;
  std::string first_wrong;
  const std::uint32_t num_frames = recon->num_frames();
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    recon->frame(f, positions);
    crc = crc32_of_positions(positions, per_frame ? 0 : crc);
    if (!per_frame && f + 1 < num_frames) continue;
    const std::uint32_t stored = hash.position_crc[per_frame ? f : 0];
    if (crc == stored) continue;
    ++wrong_frames;
    if (!first_wrong.empty()) continue;
    const std::uint32_t frame = index_.gofs.back().first_frame + f;
    first_wrong = (per_frame ? "of frame " : "of the GOF that ends with frame ") +
                  std::to_string(frame) + ": position_crc is " + hex(stored) +
                  ", the decoded positions give " + hex(crc);
  }
  if (wrong_frames == 0) {
    report_.hashed_frames += num_frames;
    return;
  }
  if (per_frame) {
    report_.hashed_frames += num_frames - wrong_frames;
    first_wrong += "; it differs in " + std::to_string(wrong_frames) + " of " +
                   std::to_string(num_frames) + " frames";
  }
  findings_.error({Errc::kInvalid, "R-HSH-02", "position_crc", unit.end() * 8}, first_wrong);
}

// 6.9 gof_index( ): compared with the GOFs when all are known.
void StreamValidator::gof_index(const UnitHeader& unit, const Payload& payload) {
  if (!can_read()) return;
  ElementReader r(unit, payload, findings_, Checked::kNotByDecoding);
  SequenceHeader header = lead_.header->header;
  if (header.open_end_flag && next_frame_) header.num_frames = *next_frame_;
  GofIndex index = parse_index_lists(r.bits(), header, options_.limits.max_memory_bytes);
  const FindingUnit place{report_.units, unit.type_byte, unit.offset};
  if (r.failures() == 0) {
    index_.units.push_back({place, findings_.suspect(), std::move(index)});
  }
  r.bits().byte_alignment();
  r.bits().expect_end();
}

// 6.10 metadata( )
void StreamValidator::metadata(const UnitHeader& unit, const Payload& payload) {
  BitReader r = bits_of(unit, payload);
  const auto json = parse_metadata(r, memory_limit());
  if (!json) return findings_.error(json.error());
  if (const auto at = find_json_error(*json)) {
    findings_.unchecked("R-MET-03", "metadata_json", unit.payload_offset() * 8 + 32,
                        "byte " + std::to_string(*at) + " of " + std::to_string(json->size()) +
                            " inflated bytes is not JSON");
  }
}

// 6.15 clip_table( )
void StreamValidator::clip_table(const UnitHeader& unit, const Payload& payload) {
  if (!can_read()) return;
  BitReader r = bits_of(unit, payload);
  const auto clips = parse_clip_table(r, lead_.header->header.num_frames, memory_limit());
  if (!clips) return findings_.error(clips.error());
  for (const Clip& clip : *clips) {
    const std::size_t at = find_clip_name_error(clip.name);
    if (at == clip.name.size()) continue;
    findings_.unchecked("R-CLP-03", "clip_name_byte", unit.payload_offset() * 8,
                        "byte " + std::to_string(at) + " of the name of the clip from frame " +
                            std::to_string(clip.first_frame));
    return;
  }
}

// 6.8 end_of_sequence( )
void StreamValidator::end_of_sequence(const UnitHeader& unit, const Payload& payload) {
  ElementReader r(unit, payload, findings_);
  const bool has_header = lead_.header && lead_.header->usable;
  const SequenceHeader header = has_header ? lead_.header->header : SequenceHeader{};
  const auto [distance, num_frames] = parse_end_of_sequence(r.bits(), header);
  const bool follows_index = previous_ && previous_->type() == UnitType::kGofIndex;
  const bool leads_to_it = follows_index && previous_->offset + distance == unit.offset;
  if (leads_to_it) ++index_.units_found;
  if (distance != 0 && r.readable() && !leads_to_it && previous_) {
    findings_.unchecked(
        "R-END-03", "index_distance", unit.payload_offset() * 8,
        "index_distance is " + std::to_string(distance) + "; " +
            (follows_index
                 ? "the GOF index unit starts " +
                       std::to_string(unit.offset - previous_->offset) + " bytes before"
                 : "the unit directly before is no GOF index unit"));
  }
  if (!has_header) return;
  findings_.suspect(findings_.suspect() || lead_.header_suspect || frames_suspect_);
  if (next_frame_ && *next_frame_ != num_frames && r.readable()) {
    findings_.error({Errc::kInvalid, "R-END-01", "unit_type", unit.offset * 8},
                    "the GOFs have " + std::to_string(*next_frame_) + " frames, the " +
                        (header.open_end_flag ? "end_of_sequence unit" : "sequence header") +
                        " announces " + std::to_string(num_frames));
  }
}

}  // namespace rlpc
