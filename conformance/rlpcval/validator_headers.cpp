#include "conformance/rlpcval/validator_headers.h"

#include <algorithm>
#include <string>

#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "conformance/rlpcval/validator_checks.h"
#include "conformance/rlpcval/validator_frames.h"

namespace rlpc {
namespace {

constexpr std::int64_t kMaxCode = 0xFFFFFFFE;  // 2^32 - 2

// Neither the grid nor the frame rate influences decoding.
void check_rate_and_grid(ElementReader& r, SequenceHeader& h) {
  const auto rate = [&](const char* element) {
    const std::int64_t value = r.ue(element);
    r.require(value <= kMaxCode, "R-HDR-03", at_most(kMaxCode));
    return static_cast<std::uint32_t>(value) + 1;
  };
  h.frame_rate.numerator = rate("frame_rate_numerator_minus1");
  h.frame_rate.denominator = rate("frame_rate_denominator_minus1");
  const std::int64_t log2_step = r.se("grid_log2_step");
  r.require(log2_step >= kMinGridLog2Step && log2_step <= kMaxGridLog2Step, "R-HDR-04",
            between(kMinGridLog2Step, kMaxGridLog2Step));
  h.grid.log2_step = static_cast<std::int32_t>(log2_step);
  for (std::int32_t& out : h.grid.origin) {
    const std::int64_t origin = r.se("grid_origin");
    r.require(origin >= -kMaxGridOrigin && origin <= kMaxGridOrigin, "R-HDR-05",
              between(-kMaxGridOrigin, kMaxGridOrigin));
    out = static_cast<std::int32_t>(origin);
  }
}

}  // namespace

// 6.3 sequence_header( )
HeaderCheck check_sequence_header(ElementReader& r, std::uint32_t version_minor) {
  HeaderCheck check;
  SequenceHeader& h = check.header;
  h.profile_idc = static_cast<std::uint32_t>(r.u(8, "profile_idc"));
  r.supported(h.profile_idc <= version_minor, "R-HDR-01",
              "version 1." + std::to_string(version_minor) + " does not have it");
  check.supported = !r.readable() || h.profile_idc == version_minor;
  if (!r.readable() || !check.supported) return check;
  h.level_idc = static_cast<std::uint32_t>(r.u(8, "level_idc"));
  const bool known_level = h.level_idc >= 1 && h.level_idc <= kMaxLevelIdc;
  r.supported(known_level, "R-HDR-02", "this version has levels 1 to 4");
  check.supported = !r.readable() || known_level;
  if (!r.readable() || !check.supported) return check;
  const Level& level = h.level();
  const Level& highest = kLevels.back();
  check.places.num_vertices_minus1 = r.bit_pos();
  const std::int64_t vertices = r.ue("num_vertices_minus1");
  r.require(vertices < level.max_vertices, "R-LVL-01",
            level_allows(h.level_idc, level.max_vertices, " vertices"));
  check.places.num_triangles = r.bit_pos();
  const std::int64_t triangles = r.ue("num_triangles");
  r.require(triangles <= level.max_triangles, "R-LVL-02",
            level_allows(h.level_idc, level.max_triangles, " triangles"));
  check.places.open_end_flag = r.bit_pos();
  if (h.profile_idc >= kProfileHigh) h.open_end_flag = r.u(1, "open_end_flag") != 0;
  check.places.num_frames_minus1 = r.bit_pos();
  std::int64_t frames = kMaxFrames - 1;
  if (!h.open_end_flag) {
    frames = r.ue("num_frames_minus1");
    r.require(frames < kMaxFrames, "R-LVL-03",
              "a sequence has at most " + std::to_string(kMaxFrames) + " frames");
  }
  check.usable = r.readable() && vertices < highest.max_vertices &&
                 triangles <= highest.max_triangles && frames < kMaxFrames;
  check.places.frame_rate_numerator_minus1 = r.bit_pos();
  check_rate_and_grid(r, h);
  const std::int64_t bits = r.u(5, "position_bits");
  check.positions = r.require(bits >= kMinPositionBits && bits <= kMaxPositionBits, "R-HDR-06",
                              between(kMinPositionBits, kMaxPositionBits));
  r.byte_alignment();
  r.expect_end();
  if (check.usable) {
    h.num_vertices = static_cast<std::uint32_t>(vertices) + 1;
    h.num_triangles = static_cast<std::uint32_t>(triangles);
    h.num_frames = static_cast<std::uint32_t>(frames) + 1;
  }
  if (check.positions) h.position_bits = static_cast<int>(bits);
  return check;
}

namespace {

// 6.5 gof( ), the elements of all profiles. Returns false if its section cannot be read.
bool check_gof_frames(ElementReader& r, const SequenceHeader& header,
                      std::optional<std::uint32_t> expected_first_frame, GofHeaderCheck& gof) {
  const Level& level = header.level();
  const std::int64_t first = r.ue("first_frame");
  const bool in_sequence = first < header.num_frames;
  r.require(expected_first_frame ? first == *expected_first_frame : in_sequence, "R-GOF-01",
            expected_first_frame
                ? "the GOFs before have " + std::to_string(*expected_first_frame) + " frames"
                : "the sequence has " + std::to_string(header.num_frames) + " frames");
  const std::int64_t left = header.num_frames - first;
  const std::int64_t frames = r.ue("num_gof_frames_minus1") + 1;
  bool good = in_sequence;
  if (in_sequence) {
    good &= r.require(frames <= left, "R-GOF-02",
                      "the sequence has " + std::to_string(left) + " frames left");
  }
  // In the order of the decoding process: skipped if R-GOF-02 failed.
  if (!good) return false;
  const auto values = static_cast<std::uint64_t>(frames) * header.num_vertices;
  good = r.require(frames <= level.max_gof_frames && values <= level.max_gof_values, "R-LVL-04",
                   level_allows(header.level_idc, level.max_gof_frames, " frames of a GOF, ") +
                       std::to_string(level.max_gof_values) + " vertices times frames");
  gof.first_frame = static_cast<std::uint32_t>(first);
  gof.num_frames = r.readable() ? static_cast<std::uint32_t>(frames) : 0;
  return good;
}

bool check_fraction_bits(ElementReader& r) {
  const std::int64_t fraction_bits = r.u(5, "fraction_bits");
  return r.require(fraction_bits <= kMaxFractionBits, "R-GOF-03", at_most(kMaxFractionBits));
}

// 6.5 clusters_of_gof( )
bool check_clusters(ElementReader& r, const SequenceHeader& header) {
  const Level& level = header.level();
  const std::int64_t clusters = r.ue("num_clusters_minus1") + 1;
  bool good =
      r.require(clusters <= level.max_clusters, "R-LVL-06",
                level_allows(header.level_idc, level.max_clusters, " clusters of a GOF"));
  good &= check_fraction_bits(r);
  const std::int64_t seed_step = r.ue("seed_step_minus1");
  good &= r.require(seed_step < kMaxSeedStep, "R-GOF-04", at_most(kMaxSeedStep - 1));
  const std::int64_t seed_predictor = r.u(3, "seed_predictor");
  good &=
      r.require(seed_predictor <= kMaxPredictorOrder, "R-GOF-05", at_most(kMaxPredictorOrder));
  (void)r.u(1, "seed_coupling_flag");
  return check_alignment(r) && good;
}

// 6.11 layers_of_rig( ). Returns false if its end is not known.
bool check_layers(ElementReader& r, const SequenceHeader& header, std::uint32_t num_layers,
                  std::uint32_t& layer_groups) {
  (void)r.u(4, "damping_log2");
  (void)r.u(4, "outer_weight");
  (void)r.u(4, "outer_scale");
  if (header.profile_idc >= kProfileHigh) {
    const Level& level = header.level();
    const std::int64_t adaptive = r.ue("num_adaptive_factors");
    // In the order of the decoding process: R-LVL-09 is skipped if R-BON-06 failed.
    if (r.require(
            adaptive <= level.max_components, "R-BON-06",
            level_allows(header.level_idc, level.max_components, " trajectories of a GOF"))) {
      const auto values = static_cast<std::uint64_t>(adaptive) * header.num_vertices;
      (void)r.require(values <= level.max_adaptive_values, "R-LVL-09",
                      level_allows(header.level_idc, level.max_adaptive_values,
                                   " adaptive trajectories times vertices"));
    }
  }
  if (!check_layer_groups(r, num_layers, layer_groups)) return false;
  for (std::uint32_t i = 0; i < num_layers; ++i) (void)r.u(4, "layer_step_minus1");
  return r.readable();
}

// 6.11 rig_header( ). Returns false if the section after it cannot be read.
bool check_rig(ElementReader& r, const SequenceHeader& header, std::uint32_t num_layers,
               std::optional<SliceCounts>& counts) {
  const Level& level = header.level();
  const std::int64_t bones = r.ue("num_bones_minus1") + 1;
  bool good = r.require(bones <= level.max_clusters, "R-LVL-06",
                        level_allows(header.level_idc, level.max_clusters, " bones of a GOF"));
  good &= check_fraction_bits(r);
  (void)r.u(3, "weight_bits");
  const std::int64_t rest_step = r.ue("rest_step_minus1");
  good &= r.require(rest_step < kMaxRestStep, "R-BON-01", at_most(kMaxRestStep - 1));
  const std::int64_t groups = r.ue("num_component_groups");
  const bool good_groups =
      r.require(groups <= kMaxComponentGroups, "R-BON-02", at_most(kMaxComponentGroups));
  good &= good_groups;
  SliceCounts slices;
  const auto prediction = static_cast<Prediction>(r.u(2, "prediction_idc"));
  if (prediction == Prediction::kLayers &&
      !check_layers(r, header, num_layers, slices.layer_groups)) {
    return false;
  }
  if (header.profile_idc >= kProfileHigh) read_rest_order(r);
  if (good_groups && r.readable()) {
    slices.component_groups = static_cast<std::uint32_t>(groups);
    counts = slices;
  }
  return check_alignment(r) && good;
}

// 6.11 levels_of_tracks( ). Returns false if there are more temporal layers than levels.
bool check_levels(ElementReader& r, std::uint32_t& temporal_layers) {
  const std::int64_t levels = r.u(3, "track_levels");
  if (levels == 0) return true;
  const std::int64_t layers = r.u(3, "num_temporal_layers_minus1") + 1;
  temporal_layers = static_cast<std::uint32_t>(layers);
  return r.require(layers <= levels + 1, "R-TRK-01",
                   at_most(static_cast<std::uint64_t>(levels)));
}

// 6.13.1 tracks_of_gof( )
bool check_tracks(ElementReader& r, const SeenRigs& rigs, GofHeaderCheck& gof) {
  const auto rig_idx = static_cast<std::size_t>(r.u(3, "rig_idx"));
  const SeenRig& kept = rigs[rig_idx];
  if (!r.supported(kept.rig || kept.lost, "R-MOD-01",
                   "the stream has no shared rig " + std::to_string(rig_idx) + " up to here")) {
    return false;
  }
  std::uint32_t temporal_layers = 1;
  const bool good_layers = check_levels(r, temporal_layers);
  const std::int64_t groups = r.ue("num_local_groups");
  if (!kept.rig || !r.readable()) return false;
  gof.rig_suspect = kept.suspect;
  const std::uint32_t of_rig = kept.rig->num_component_groups;
  const bool good = r.require(
      groups <= kMaxComponentGroups - of_rig, "R-BON-02",
      "the shared rig has " + std::to_string(of_rig) + " of " + at_most(kMaxComponentGroups));
  if (good) {
    gof.slices = SliceCounts{of_rig + static_cast<std::uint32_t>(groups),
                             static_cast<std::uint32_t>(kept.rig->layer_group_size.size()),
                             temporal_layers};
  }
  return check_alignment(r) && good && good_layers;
}

// 6.11 bones_of_gof( )
bool check_bones(ElementReader& r, const SequenceHeader& header, std::uint32_t num_layers,
                 GofHeaderCheck& gof) {
  std::uint32_t temporal_layers = 1;
  const bool good = header.profile_idc < kProfileHigh || check_levels(r, temporal_layers);
  const bool good_rig = check_rig(r, header, num_layers, gof.slices);
  if (gof.slices) gof.slices->temporal_layers = temporal_layers;
  return good && good_rig;
}

// Returns none if it could not be read.
std::optional<GofKind> check_kind(ElementReader& r, const SequenceHeader& header) {
  std::int64_t kind = 0;
  if (header.profile_idc == kProfileMain) kind = r.u(1, "bones_flag");
  if (header.profile_idc >= kProfileHigh) kind = r.u(2, "gof_kind");
  if (!r.readable()) return std::nullopt;
  return static_cast<GofKind>(kind);
}

}  // namespace

// 6.5 gof( )
GofHeaderCheck check_gof_header(ElementReader& r, const SequenceHeader& header,
                                std::optional<std::uint32_t> expected_first_frame,
                                std::uint32_t num_layers, const SeenRigs& rigs) {
  GofHeaderCheck gof;
  const bool good = check_gof_frames(r, header, expected_first_frame, gof);
  gof.kind = check_kind(r, header);
  if (!gof.kind) return gof;
  switch (*gof.kind) {
    case GofKind::kCluster:
      gof.section_readable = check_clusters(r, header);
      break;
    case GofKind::kSkinned:
      gof.section_readable = check_bones(r, header, num_layers, gof);
      break;
    case GofKind::kSharedRig:
      gof.section_readable = check_tracks(r, rigs, gof);
      break;
    case GofKind::kInter:
      gof.section_readable = check_frames(r, header, num_layers, gof);
  }
  gof.section_readable &= good;
  return gof;
}

// 6.13 rig( )
RigHeaderCheck check_rig_header(ElementReader& r, const SequenceHeader& header,
                                std::uint32_t num_layers) {
  RigHeaderCheck rig;
  const std::int64_t rig_idx = r.u(3, "rig_idx");
  if (!r.readable()) return rig;
  rig.rig_idx = static_cast<std::uint32_t>(rig_idx);
  rig.section_readable = check_rig(r, header, num_layers, rig.slices);
  return rig;
}

// 6.12 slice_unit( )
bool check_slice_header(ElementReader& r, const SliceCounts& slices) {
  if (slices.frames > 0) return check_frame_header(r, slices);
  bool good = true;
  std::int64_t temporal_layer = 0;
  if (slices.temporal_layers > 1) {
    temporal_layer = r.u(3, "temporal_layer_idx");
    good =
        r.require(temporal_layer < slices.temporal_layers, "R-SLI-01",
                  "the GOF has " + std::to_string(slices.temporal_layers) + " temporal layers");
  }
  const std::int64_t group = r.ue("component_group_idx");
  good &=
      r.require(group <= slices.component_groups, "R-SLI-01",
                "the GOF has " + std::to_string(slices.component_groups) + " component groups");
  if (temporal_layer > 0) return good && r.readable();
  const std::int64_t layers = r.ue("layer_group_idx");
  good &= r.require(layers < slices.layer_groups, "R-SLI-01",
                    "the GOF has " + std::to_string(slices.layer_groups) + " layer groups");
  return good && r.readable();
}

namespace {

// 6.9 index_of_rigs( ). Returns false if the index is not readable to its end.
bool check_index_of_rigs(ElementReader& r, std::uint32_t num_frames,
                         std::uint64_t max_memory_bytes, GofIndexCheck& index) {
  const std::int64_t num_rigs = r.ue("num_index_rigs");
  bool good = r.require(num_rigs <= num_frames, "R-IDX-05",
                        "the sequence has " + std::to_string(num_frames) + " frames");
  std::uint64_t offset = 0;
  for (std::int64_t m = 0; m < num_rigs && r.readable(); ++m) {
    if (index.rigs.size() * sizeof(RigLocation) > max_memory_bytes) {
      index.too_large = true;
      return false;
    }
    const auto rig_idx = static_cast<std::uint32_t>(r.u(3, "index_rig_idx"));
    const std::int64_t distance = r.ue("index_rig_distance");
    good &= r.require(distance <= kMaxCode, "R-IDX-02", at_most(kMaxCode));
    offset += static_cast<std::uint64_t>(distance);
    index.rigs.push_back({offset, rig_idx});
  }
  return good && r.readable();
}

}  // namespace

// 6.9 gof_index( )
GofIndexCheck check_gof_index(ElementReader& r, const SequenceHeader& header,
                              std::uint64_t max_memory_bytes) {
  const std::uint32_t num_frames = header.num_frames;
  GofIndexCheck index;
  const std::string sum = "the sequence has " + std::to_string(num_frames) + " frames";
  const std::int64_t num_gofs = r.ue("num_index_gofs_minus1") + 1;
  bool good = r.require(num_gofs <= num_frames, "R-IDX-01", sum);
  GofLocation next{static_cast<std::uint64_t>(r.ue("first_gof_offset")), 0};
  good &= r.require(static_cast<std::int64_t>(next.offset) <= kMaxCode, "R-IDX-02",
                    at_most(kMaxCode));
  std::int64_t g = 0;
  for (; g < num_gofs && r.readable() && next.first_frame < num_frames; ++g) {
    if (index.gofs.size() * sizeof(GofLocation) > max_memory_bytes) {
      index.too_large = true;
      return index;
    }
    index.gofs.push_back(next);
    const std::int64_t frames = r.ue("index_gof_frames_minus1") + 1;
    const std::int64_t left = std::int64_t{num_frames} - next.first_frame;
    if (!r.require(frames <= left, "R-IDX-01", sum)) return index;
    next.first_frame += static_cast<std::uint32_t>(frames);
    const std::int64_t bytes = r.ue("index_gof_bytes");
    good &= r.require(bytes <= kMaxCode, "R-IDX-02", at_most(kMaxCode));
    next.offset += static_cast<std::uint64_t>(bytes);
  }
  if (!r.readable()) return index;
  const std::string lists = "the GOFs listed have " + std::to_string(next.first_frame) +
                            " frames in " + std::to_string(g) + " of " +
                            std::to_string(num_gofs) + " GOFs; ";
  // Reports the rule once.
  if (good)
    good = r.require(g == num_gofs && next.first_frame == num_frames, "R-IDX-01", lists + sum);
  if (g < num_gofs) return index;
  if (header.profile_idc >= kProfileHigh) {
    good &= check_index_of_rigs(r, num_frames, max_memory_bytes, index);
    if (index.too_large) return index;
  }
  r.byte_alignment();
  r.expect_end();
  index.end = next.offset;
  index.readable = good;
  return index;
}

}  // namespace rlpc
