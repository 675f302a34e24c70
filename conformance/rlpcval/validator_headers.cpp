#include "conformance/rlpcval/validator_headers.h"

#include <algorithm>

#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "decoder/codec/kinds/cluster/parse/parse_cluster_gof.h"
#include "decoder/codec/parse/parse_gof_header.h"

namespace rlpc {

// 6.3 sequence_header( )
HeaderCheck check_sequence_header(ElementReader& r, std::uint32_t version_minor) {
  HeaderCheck check;
  SequenceHeader& h = check.header;
  h = parse_sequence_header(r.bits(), version_minor, check.places);
  const auto& error = r.bits().error();
  check.supported = !error || error->code != Errc::kUnsupported;
  const Level& highest = kLevels.back();
  check.usable = check.places.frame_rate_numerator_minus1 > 0 &&
                 h.num_vertices <= highest.max_vertices &&
                 h.num_triangles <= highest.max_triangles && h.num_frames <= kMaxFrames;
  check.positions = r.readable() && h.position_bits >= kMinPositionBits &&
                    h.position_bits <= kMaxPositionBits;
  if (!check.positions) h.position_bits = SequenceHeader{}.position_bits;
  return check;
}

namespace {

// 6.5 gof( ), the numbers of frames. Returns the number of findings about first_frame.
std::uint32_t check_gof_frames(ElementReader& r, const SequenceHeader& header,
                               std::optional<std::uint32_t> expected_first_frame,
                               GofHeaderCheck& gof) {
  const std::uint64_t at = r.bits().bit_pos();
  const std::uint32_t first =
      parse_first_frame(r.bits(), {0, std::int64_t{header.num_frames} - 1});
  if (expected_first_frame) {
    r.bits().require({"first_frame", first, at}, first == *expected_first_frame, "R-GOF-01");
  }
  const std::uint32_t failures = r.failures();
  // Of a GOF outside the sequence, it is not known how many frames it can have.
  const std::uint32_t left = header.num_frames - std::min(first, header.num_frames);
  const std::uint32_t num_frames = parse_num_gof_frames(r.bits(), header, left);
  if (r.readable() && num_frames <= left) {
    gof.first_frame = first;
    gof.num_frames = num_frames;
  }
  return failures;
}

// 6.11 rig_header( )
UnitCounts check_rig(ElementReader& r, const SequenceHeader& header, std::uint32_t num_layers,
                     int temporal_layers) {
  SharedRig rig;
  parse_rig_header(r.bits(), header, num_layers, rig);
  if (!r.readable() || rig.num_component_groups > kMaxComponentGroups) return {};
  SliceCounts counts;
  counts.component_groups = rig.num_component_groups;
  if (rig.prediction == Prediction::kLayers) {
    counts.layer_groups = static_cast<std::uint32_t>(rig.layer_group_size.size());
  }
  counts.temporal_layers = static_cast<std::uint32_t>(temporal_layers);
  return counts;
}

// 6.11 bones_of_gof( )
UnitCounts check_bones(ElementReader& r, const SequenceHeader& header,
                       std::uint32_t num_layers) {
  SkinnedGof tracks;
  if (header.profile_idc >= kProfileHigh) parse_levels_of_tracks(r.bits(), tracks);
  return check_rig(r, header, num_layers, tracks.num_temporal_layers);
}

// 6.13.1 tracks_of_gof( )
UnitCounts check_tracks(ElementReader& r, const SeenRigs& rigs, bool& rig_suspect) {
  const std::uint64_t at = r.bits().bit_pos();
  const std::uint32_t rig_idx = parse_rig_idx(r.bits());
  const SeenRig& kept = rigs[rig_idx];
  if (!kept.rig && !kept.lost) r.bits().fail(Errc::kUnsupported, "R-MOD-01", "rig_idx", at);
  // Of a lost rig, it is not known how many groups it leaves.
  const std::uint32_t rig_groups =
      kept.rig ? kept.rig->num_component_groups : kMaxComponentGroups + 1;
  SkinnedGof tracks;
  parse_tracks_header(r.bits(), rig_groups, tracks);
  if (!kept.rig || !r.readable()) return {};
  rig_suspect = kept.suspect;
  r.bits().byte_alignment();
  if (tracks.num_local_groups > kMaxComponentGroups - rig_groups) return {};
  return SliceCounts{rig_groups + tracks.num_local_groups,
                     static_cast<std::uint32_t>(kept.rig->layer_group_size.size()),
                     static_cast<std::uint32_t>(tracks.num_temporal_layers)};
}

// 6.14 frames_of_gof( )
UnitCounts check_frames(ElementReader& r, const SequenceHeader& header,
                        std::uint32_t num_layers, std::uint32_t num_frames) {
  InterSettings settings;
  parse_inter_settings(r.bits(), header, num_layers, settings);
  if (num_frames == 0 || settings.layer_step.empty()) return {};
  return FrameCounts{num_frames, static_cast<std::uint32_t>(settings.layer_group_size.size())};
}

}  // namespace

// 6.5 gof( )
GofHeaderCheck check_gof_header(ElementReader& r, const SequenceHeader& header,
                                std::optional<std::uint32_t> expected_first_frame,
                                std::uint32_t num_layers, const SeenRigs& rigs) {
  GofHeaderCheck gof;
  const std::uint32_t failures = check_gof_frames(r, header, expected_first_frame, gof);
  const GofKind kind = parse_gof_kind(r.bits(), header);
  if (!r.readable()) return gof;
  gof.kind = kind;
  switch (kind) {
    case GofKind::kCluster: {
      ClusterGof clusters;
      parse_clusters_header(r.bits(), header, clusters);
      break;
    }
    case GofKind::kSkinned:
      gof.units = check_bones(r, header, num_layers);
      break;
    case GofKind::kSharedRig:
      gof.units = check_tracks(r, rigs, gof.rig_suspect);
      break;
    case GofKind::kInter:
      gof.units = check_frames(r, header, num_layers, gof.num_frames);
  }
  const bool has_units = !has_slices(kind) || is_known(gof.units);
  gof.section_readable =
      r.readable() && r.failures() == failures && gof.num_frames > 0 && has_units;
  return gof;
}

// 6.13 rig( )
RigHeaderCheck check_rig_header(ElementReader& r, const SequenceHeader& header,
                                std::uint32_t num_layers) {
  RigHeaderCheck rig;
  const std::uint32_t rig_idx = parse_rig_idx(r.bits());
  if (!r.readable()) return rig;
  rig.rig_idx = rig_idx;
  rig.units = check_rig(r, header, num_layers, 1);
  rig.section_readable = r.readable() && r.failures() == 0;
  return rig;
}

// 6.12 slice_unit( ), 6.14.2 frame_unit( )
bool check_unit_header(ElementReader& r, const SequenceHeader& header,
                       const UnitCounts& counts) {
  if (const auto* slices = std::get_if<SliceCounts>(&counts)) {
    parse_slice_header(r.bits(), *slices);
  } else if (const auto* frames = std::get_if<FrameCounts>(&counts)) {
    parse_frame_unit_header(r.bits(), header, *frames);
  }
  return r.readable() && r.failures() == 0;
}

}  // namespace rlpc
