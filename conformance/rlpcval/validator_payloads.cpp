// What units hold: 6.3 to 6.12, and the hash check of 8.6.2.
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

#include "common/bitstream/crc32.h"
#include "common/cluster_gof/recon/cluster_recon.h"
#include "common/skinned_gof/recon/skinned_recon.h"
#include "conformance/rlpcval/validator_elements.h"
#include "conformance/rlpcval/validator_json.h"
#include "conformance/rlpcval/validator_stream.h"
#include "decoder/parse/parse_cluster_gof.h"
#include "decoder/parse/parse_connectivity.h"
#include "decoder/parse/parse_gof_hash.h"
#include "decoder/parse/parse_metadata.h"
#include "decoder/parse/parse_vertex_order.h"

namespace rlpc {
namespace {

BitReader bits_of(const UnitHeader& unit, const std::vector<std::uint8_t>& payload) {
  return BitReader(payload, unit.payload_offset() * 8);
}

std::string hex(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08X", value);
  return text;
}

// What the rest of a stream is read with is kept, up to the limits of the caller.
std::uint64_t memory_of(const SequenceHeader& h) {
  const std::uint64_t of_vertex = h.profile_idc == kProfileMain ? 400 : 100;
  return std::uint64_t{h.num_vertices} * of_vertex + std::uint64_t{h.num_triangles} * 120;
}

}  // namespace

// 6.2 unit_payload( ). `sound`: the CRC of the unit holds.
void StreamValidator::read_payload(const UnitHeader& unit, bool sound) {
  const bool read = !unit.ancillary() || (unit.type_byte >= 0x81 && unit.type_byte <= 0x83);
  if (!read) return;
  if (unit.type() == UnitType::kGof) begin_gof(unit);
  const auto payload = units_.payload(unit);
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
      return slice(unit, *payload);
    case UnitType::kEndOfSequence:
      return end_of_sequence(unit, *payload);
    case UnitType::kGofIndex:
      return gof_index(unit, *payload);
    case UnitType::kGofHash:
      return gof_hash(unit, *payload);
    case UnitType::kMetadata:
      return metadata(unit, *payload);
  }
}

bool StreamValidator::can_read() {
  findings_.suspect(findings_.suspect() || header_suspect_);
  if (header_ && header_->usable && within_limits_) return true;
  report_.complete = false;
  return false;
}

// 6.3 sequence_header( )
void StreamValidator::sequence_header(const UnitHeader& unit, const Payload& payload) {
  if (header_) return;  // it stands in the wrong place, that was said
  ElementReader r(payload, unit.payload_offset() * 8, findings_);
  header_ = check_sequence_header(r, units_.version_minor());
  header_bit_pos_ = unit.payload_offset() * 8;
  header_suspect_ = findings_.suspect() || r.failures() > 0;
  if (!header_->supported) unsupported_ = true;
  if (!header_->supported && r.failures() == 0) {
    findings_.in_unit(std::nullopt);
    findings_.error(unsupported_minor_version(),
                    "version 1." + std::to_string(units_.version_minor()) +
                        " is not the first that has the profile of the stream, " +
                        std::to_string(header_->header.profile_idc));
  }
  if (!header_->usable) return;
  units_.set_max_unit_bytes(header_->header.level().max_unit_bytes);
  report_.header = header_->header;
  check_limits();
}

void StreamValidator::check_limits() {
  const DecodeLimits& limits = options_.limits;
  const SequenceHeader& h = header_->header;
  const char* element = nullptr;
  if (memory_of(h) > limits.max_memory_bytes) element = "num_vertices_minus1";
  if (h.num_frames > limits.max_frames) element = "num_frames_minus1";
  if (h.num_triangles > limits.max_triangles) element = "num_triangles";
  if (h.num_vertices > limits.max_vertices) element = "num_vertices_minus1";
  within_limits_ = element == nullptr;
  if (within_limits_) return;
  findings_.error({Errc::kLimitExceeded, "", element, header_bit_pos_});
}

// 6.4 Connectivity
void StreamValidator::connectivity(const UnitHeader& unit, const Payload& payload) {
  if (has_connectivity_ || !can_read()) return;
  connectivity_suspect_ = findings_.suspect();
  const SequenceHeader& h = header_->header;
  BitReader r = bits_of(unit, payload);
  const auto triangles = parse_connectivity(r, h.num_vertices, h.num_triangles);
  if (!triangles) {
    findings_.error(triangles.error());
    report_.complete = false;
    return;
  }
  topology_ = make_topology(h.num_vertices, *triangles);
  if (h.profile_idc == kProfileMain) mesh_predictions_.emplace(topology_, *triangles);
  has_connectivity_ = true;
}

// 6.6 vertex_order( )
void StreamValidator::vertex_order(const UnitHeader& unit, const Payload& payload) {
  if (has_vertex_order_ || !can_read()) return;
  BitReader r = bits_of(unit, payload);
  const auto order = parse_vertex_order(r, header_->header.num_vertices);
  has_vertex_order_ = static_cast<bool>(order);
  if (!order) findings_.error(order.error());
}

// What is known of a GOF before it is read.
void StreamValidator::begin_gof(const UnitHeader& unit) {
  gofs_.push_back({unit.offset, 0});
  gof_unit_ = unit;
  gof_place_ = {report_.units, unit.type_byte, unit.offset};
  may_have_slices_ = true;
  slice_counts_.reset();
  bone_parser_.reset();
  previous_gof_.reset();
  previous_bones_.reset();
  previous_gof_frames_ = 0;
  expected_first_frame_ = std::exchange(next_frame_, std::nullopt);
}

// 6.5 gof( )
void StreamValidator::gof(const UnitHeader& unit, const Payload& payload) {
  if (!can_read()) return;
  const bool damaged = findings_.suspect();
  findings_.suspect(damaged || frames_suspect_);
  // One GOF too many was said; it may be a copy of any other.
  const bool surplus = expected_first_frame_ == header_->header.num_frames;
  ElementReader r(payload, unit.payload_offset() * 8, findings_);
  const std::uint32_t num_layers =
      mesh_predictions_ ? mesh_predictions_->get(Prediction::kLayers).num_layers() : 0;
  const GofHeaderCheck header = check_gof_header(
      r, header_->header, surplus ? std::nullopt : expected_first_frame_, num_layers);
  may_have_slices_ = damaged || header.bones_flag.value_or(true);
  slice_counts_ = header.slices;
  frames_suspect_ = r.failures() > 0 || damaged || surplus;
  previous_gof_frames_ = header.num_frames;
  if (header.num_frames > 0) {
    gofs_.back().first_frame = header.first_frame;
    ++known_first_frames_;
    next_frame_ = header.first_frame + header.num_frames;
  }
  if (surplus) next_frame_ = expected_first_frame_;
  previous_gof_suspect_ = damaged || connectivity_suspect_;
  findings_.suspect(previous_gof_suspect_);
  if (header.bones_flag.value_or(false)) {
    bone_section(unit, payload, header);
  } else {
    gof_section(unit, payload, header);
  }
}

// 6.5.1 gof_section( )
void StreamValidator::gof_section(const UnitHeader& unit, const Payload& payload,
                                  const GofHeaderCheck& header) {
  if (!header.section_readable || !has_connectivity_) {
    report_.complete = false;
    return;
  }
  BitReader r = bits_of(unit, payload);
  const GofStart start = parse_gof_start(r, header_->header, header.first_frame);
  auto gof =
      parse_clusters(r, header_->header, topology_, start, options_.limits.max_memory_bytes);
  if (!gof) {
    findings_.error(gof.error());
    report_.complete = false;
    return;
  }
  ++report_.gofs;
  report_.frames += gof->num_frames;
  warn_of_gof(unit, *gof);
  previous_gof_ = std::move(*gof);
}

// 6.11.1 bone_section( )
void StreamValidator::bone_section(const UnitHeader& unit, const Payload& payload,
                                   const GofHeaderCheck& header) {
  if (!header.section_readable || !mesh_predictions_ || !header_->positions) {
    report_.complete = false;
    return;
  }
  bone_parser_.emplace(header_->header, *mesh_predictions_, options_.limits.max_memory_bytes);
  BitReader r = bits_of(unit, payload);
  const GofStart start = parse_gof_start(r, header_->header, header.first_frame);
  if (const auto read = bone_parser_->bones(r, start); !read) {
    findings_.error(read.error());
    report_.complete = false;
    bone_parser_.reset();
  }
}

// 6.12 slice_unit( )
void StreamValidator::slice(const UnitHeader& unit, const Payload& payload) {
  if (!can_read()) return;
  if (!gof_unit_ || !slice_counts_) {
    report_.complete = false;
    return;
  }
  previous_gof_suspect_ = previous_gof_suspect_ || findings_.suspect();
  findings_.suspect(previous_gof_suspect_);
  ElementReader header(payload, unit.payload_offset() * 8, findings_);
  bool read = check_slice_header(header, *slice_counts_);
  if (read && bone_parser_) {
    BitReader r = bits_of(unit, payload);
    const auto result = bone_parser_->slice(r, unit.offset * 8);
    if (!result) findings_.error(result.error());
    read = static_cast<bool>(result);
  }
  needed_.max_unit_bytes = std::max<std::uint64_t>(needed_.max_unit_bytes, unit.size);
  if (read) return;
  // What slices behind it hold depends on it.
  report_.complete = false;
  previous_gof_suspect_ = true;
  bone_parser_.reset();
}

// 8.14.1: slices at the end of a GOF can be absent.
void StreamValidator::end_slices() {
  if (!bone_parser_) return;
  previous_bones_ = bone_parser_->finish();
  bone_parser_.reset();
  ++report_.gofs;
  report_.frames += previous_bones_->num_frames;
  findings_.in_unit(gof_place_);
  warn_of_bones(*gof_unit_, *previous_bones_);
}

// 6.7 gof_hash( )
void StreamValidator::gof_hash(const UnitHeader& unit, const Payload& payload) {
  if (!gof_unit_) {
    // Behind a gap, the GOF may be what was lost.
    if (previous_) {
      findings_.unchecked("R-HSH-03", "unit_type", unit.offset * 8,
                          "no GOF unit, and no slice of one, ends where it starts");
    }
    return;
  }
  if (previous_gof_frames_ == 0) {
    report_.complete = false;
    return;
  }
  findings_.suspect(findings_.suspect() || previous_gof_suspect_);
  BitReader r = bits_of(unit, payload);
  const auto hash = parse_gof_hash(r, previous_gof_frames_);
  const SequenceHeader& h = header_->header;
  if (!hash) {
    findings_.error(hash.error());
  } else if (previous_gof_ && header_->positions) {
    compare_hashes(unit, *hash, ClusterRecon(h, topology_, *previous_gof_));
  } else if (previous_bones_) {
    const CodedMesh& mesh = mesh_predictions_->get(previous_bones_->prediction);
    compare_hashes(unit, *hash, SkinnedRecon(mesh, *previous_bones_, h.position_bits));
  } else {
    report_.complete = false;
  }
}

// 8.6.2 Hash check
template <class Recon>
void StreamValidator::compare_hashes(const UnitHeader& unit, const GofHash& hash,
                                     const Recon& recon) {
  const bool per_frame = hash.per_frame_flag;
  std::vector<std::int32_t> positions(3 * std::size_t{header_->header.num_vertices});
  std::uint32_t crc = 0;
  std::uint32_t wrong_frames = 0;
  std::string first_wrong;
  const std::uint32_t num_frames = recon.num_frames();
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    recon.frame(f, positions);
    crc = crc32_of_positions(positions, per_frame ? 0 : crc);
    if (!per_frame && f + 1 < num_frames) continue;
    const std::uint32_t stored = hash.position_crc[per_frame ? f : 0];
    if (crc == stored) continue;
    ++wrong_frames;
    if (!first_wrong.empty()) continue;
    const std::uint32_t frame = gofs_.back().first_frame + f;
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
  ElementReader r(payload, unit.payload_offset() * 8, findings_, Checked::kNotByDecoding);
  indexes_.push_back(
      check_gof_index(r, header_->header.num_frames, options_.limits.max_memory_bytes));
  indexes_.back().unit = FindingUnit{report_.units, unit.type_byte, unit.offset};
  indexes_.back().suspect = findings_.suspect();
  if (indexes_.back().too_large) {
    findings_.error({Errc::kLimitExceeded, "", "num_index_gofs_minus1", r.bit_pos()});
  }
}

// 6.10 metadata( )
void StreamValidator::metadata(const UnitHeader& unit, const Payload& payload) {
  BitReader r = bits_of(unit, payload);
  const auto json = parse_metadata(r);
  if (!json) return findings_.error(json.error());
  if (const auto at = find_json_error(*json)) {
    findings_.unchecked("R-MET-03", "metadata_json", unit.payload_offset() * 8 + 32,
                        "byte " + std::to_string(*at) + " of " + std::to_string(json->size()) +
                            " inflated bytes cannot stand there");
  }
}

// 6.8 end_of_sequence( )
void StreamValidator::end_of_sequence(const UnitHeader& unit, const Payload& payload) {
  ElementReader r(payload, unit.payload_offset() * 8, findings_);
  const auto distance = static_cast<std::uint64_t>(r.u(32, "index_distance"));
  r.expect_end();
  const bool follows_index = previous_ && previous_->type() == UnitType::kGofIndex;
  const bool leads_to_it = follows_index && previous_->offset + distance == unit.offset;
  if (leads_to_it) ++index_units_found_;
  if (distance != 0 && r.readable() && !leads_to_it && previous_) {
    findings_.unchecked(
        "R-END-03", "index_distance", unit.payload_offset() * 8,
        "index_distance is " + std::to_string(distance) + "; " +
            (follows_index
                 ? "the GOF index unit starts " +
                       std::to_string(unit.offset - previous_->offset) + " bytes before"
                 : "the unit directly before is no GOF index unit"));
  }
  if (!header_ || !header_->usable) return;
  findings_.suspect(findings_.suspect() || header_suspect_ || frames_suspect_);
  if (next_frame_ && *next_frame_ != header_->header.num_frames) {
    findings_.error({Errc::kInvalid, "R-END-01", "unit_type", unit.offset * 8},
                    "the GOFs have " + std::to_string(*next_frame_) +
                        " frames, the sequence header announces " +
                        std::to_string(header_->header.num_frames));
  }
}

}  // namespace rlpc
