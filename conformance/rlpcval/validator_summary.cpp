// Findings that need the whole stream: a wrong index, and warnings of legal but unintended
// data.
#include <algorithm>
#include <string>

#include "conformance/rlpcval/validator_stream.h"

namespace rlpc {
namespace {

// Below this number of GOFs, an index saves nothing.
constexpr std::size_t kManyGofs = 16;
// Plausible frames per second: from one in ten seconds to a thousand.
constexpr std::uint64_t kMinFrameSeconds = 10;
constexpr std::uint64_t kMaxFrameRate = 1000;

}  // namespace

// 7.9: the first frames and the offsets are those of the GOF units.
void StreamValidator::compare_index(const SeenIndex& seen) {
  if (gap_) return;
  const GofIndex& index = seen.index;
  findings_.in_unit(seen.place);
  findings_.suspect(seen.suspect || frames_suspect_);
  const std::uint64_t at = (seen.place.offset + kUnitHeaderBytes) * 8;
  const bool frames_known = index_.known_first_frames == index_.gofs.size();
  const std::size_t common = std::min(index.gofs.size(), index_.gofs.size());
  for (std::size_t g = 0; g < common; ++g) {
    const GofLocation& listed = index.gofs[g];
    const GofLocation& found = index_.gofs[g];
    if (listed.offset != found.offset) {
      return findings_.unchecked("R-IDX-03", "index_gof_bytes", at,
                                 "GOF " + std::to_string(g) + " is listed at byte " +
                                     std::to_string(listed.offset) + ", its unit is at byte " +
                                     std::to_string(found.offset));
    }
    if (frames_known && listed.first_frame != found.first_frame) {
      return findings_.unchecked("R-IDX-03", "index_gof_frames_minus1", at,
                                 "GOF " + std::to_string(g) + " is listed with first frame " +
                                     std::to_string(listed.first_frame) +
                                     ", its unit has first_frame " +
                                     std::to_string(found.first_frame));
    }
  }
  if (index.gofs.size() != index_.gofs.size()) {
    return findings_.unchecked("R-IDX-03", "num_index_gofs_minus1", at,
                               std::to_string(index.gofs.size()) + " GOFs are listed, there " +
                                   "are " + std::to_string(index_.gofs.size()) + " GOF units");
  }
  if (index.end <= index.gofs.back().offset || index.end > seen.place.offset) {
    findings_.unchecked("R-IDX-03", "index_gof_bytes", at,
                        "the last GOF is listed up to byte " + std::to_string(index.end) +
                            ", the index unit is at byte " + std::to_string(seen.place.offset));
  }
}

// 7.9: the list has all rig units.
void StreamValidator::compare_rigs(const SeenIndex& seen) {
  if (gap_) return;
  const GofIndex& index = seen.index;
  findings_.in_unit(seen.place);
  findings_.suspect(seen.suspect || !index_.rig_indices_known);
  const std::uint64_t at = (seen.place.offset + kUnitHeaderBytes) * 8;
  const std::size_t common = std::min(index.rigs.size(), index_.rigs.size());
  for (std::size_t m = 0; m < common; ++m) {
    const RigLocation& listed = index.rigs[m];
    const RigLocation& found = index_.rigs[m];
    const std::string which = "rig unit " + std::to_string(m);
    if (listed.offset != found.offset) {
      return findings_.unchecked("R-IDX-06", "index_rig_distance", at,
                                 which + " is listed at byte " + std::to_string(listed.offset) +
                                     ", it is at byte " + std::to_string(found.offset));
    }
    if (index_.rig_indices_known && listed.rig_idx != found.rig_idx) {
      return findings_.unchecked("R-IDX-06", "index_rig_idx", at,
                                 which + " is listed with index " +
                                     std::to_string(listed.rig_idx) + ", its rig_idx is " +
                                     std::to_string(found.rig_idx));
    }
  }
  if (index.rigs.size() != index_.rigs.size()) {
    findings_.unchecked("R-IDX-06", "num_index_rigs", at,
                        std::to_string(index.rigs.size()) + " shared rigs are listed, " +
                            "there are " + std::to_string(index_.rigs.size()) + " units");
  }
}

void StreamValidator::warn_of_level() {
  if (findings_.failures() > 0 || !report_.complete) return;
  const SequenceHeader& h = lead_.header->header;
  for (std::uint32_t level_idc = 1; level_idc < h.level_idc; ++level_idc) {
    const Level& level = kLevels[level_idc - 1];
    if (h.num_vertices <= level.max_vertices && h.num_triangles <= level.max_triangles &&
        needed_.max_gof_frames <= level.max_gof_frames &&
        needed_.max_clusters <= level.max_clusters &&
        needed_.max_components <= level.max_components &&
        needed_.max_gof_values <= level.max_gof_values &&
        needed_.max_gof_factors <= level.max_gof_factors &&
        needed_.max_unit_bytes <= level.max_unit_bytes &&
        needed_.max_adaptive_values <= level.max_adaptive_values &&
        needed_.max_learning_vertices <= level.max_learning_vertices) {
      findings_.warning("W-LVL-01", "level_idc", lead_.header_bit_pos + 8,
                        "level_idc is " + std::to_string(h.level_idc) + ", level " +
                            std::to_string(level_idc) + " would do");
      return;
    }
  }
}

void StreamValidator::warn_of_stream() {
  findings_.suspect(findings_.failures() > 0);
  const std::uint64_t end = 8 * report_.bytes;
  if (!lead_.header || !lead_.header->usable) return;
  const FrameRate& rate = lead_.header->header.frame_rate;
  const std::uint64_t numerator = rate.numerator;
  const std::uint64_t denominator = rate.denominator;
  if (kMinFrameSeconds * numerator < denominator || numerator > kMaxFrameRate * denominator) {
    findings_.warning(
        "W-HDR-01", "frame_rate_numerator_minus1",
        lead_.header->places.frame_rate_numerator_minus1,
        std::to_string(numerator) + "/" + std::to_string(denominator) + " frames per second");
  }
  warn_of_level();
  const auto seen = [&](UnitType type) { return seen_[static_cast<std::uint8_t>(type)]; };
  const std::uint32_t gofs = seen(UnitType::kGof);
  std::uint32_t hashes = seen(UnitType::kGofHash);
  if (lead_.header && lead_.header->header.open_end_flag)
    hashes += report_.gofs_of_hashed_frames;
  if (gofs > hashes) {
    findings_.warning(
        "W-HSH-01", "gof_hash", end,
        std::to_string(gofs - hashes) + " of " + std::to_string(gofs) + " GOFs have no hash");
  }
  const std::uint32_t indexes = seen(UnitType::kGofIndex);
  if (gofs >= kManyGofs && indexes == 0) {
    findings_.warning("W-IDX-01", "gof_index", end, std::to_string(gofs) + " GOFs");
  }
  if (indexes > index_.units_found && ended_) {
    findings_.unchecked("R-IDX-04", "gof_index", end,
                        std::to_string(indexes - index_.units_found) + " of " +
                            std::to_string(indexes) + " GOF index units");
  }
  if (seen(UnitType::kMetadata) > 1) {
    findings_.warning("W-MET-01", "metadata", end,
                      std::to_string(seen(UnitType::kMetadata)) + " metadata units");
  }
  if (seen(UnitType::kClipTable) > 1) {
    findings_.warning("W-CLP-01", "clip_table", end,
                      std::to_string(seen(UnitType::kClipTable)) + " clip tables");
  }
}

}  // namespace rlpc
