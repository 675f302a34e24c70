#include "conformance/rlpcval/validator_frames.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "common/codec/kinds/inter/inter_gof.h"
#include "conformance/rlpcval/validator_checks.h"

namespace rlpc {
namespace {

// 6.14.1 explicit_pattern( )
bool check_explicit_pattern(ElementReader& r, FramePattern& pattern) {
  const std::int64_t period = r.u(5, "pattern_period_minus1") + 1;
  std::map<std::int64_t, std::int64_t> depth_at{{0, 0}};  // [offset]
  for (std::int64_t k = 0; k < period && r.readable(); ++k) {
    const std::int64_t offset = r.u(5, "pattern_offset_minus1") + 1;
    bool good = r.require(offset <= period && !depth_at.contains(offset), "R-FRM-06",
                          "a pattern has each frame of its period once");
    const bool has_two = r.u(1, "two_references_flag") != 0;
    std::array<std::int64_t, 2> references{};
    for (std::size_t i = 0; i < 2; ++i) {
      if (i == 1 && !has_two) {
        references[1] = references[0];
        continue;
      }
      references[i] = r.u(6, "pattern_reference");
      good &= r.require(depth_at.contains(references[i]), "R-FRM-06",
                        "references come before the frame in coding order");
    }
    if (good && has_two) {
      good = r.require(references[0] < offset && references[1] > offset, "R-FRM-06",
                       "of two references, the first is before the frame, the second after it");
    }
    const std::int64_t depth = r.u(3, "pattern_depth");
    if (!good || !r.readable()) return false;
    const std::int64_t least = std::max(depth_at[references[0]], depth_at[references[1]]);
    if (!r.require(depth >= least, "R-FRM-06",
                   "a frame is at least as deep as its references: " + std::to_string(least))) {
      return false;
    }
    depth_at[offset] = depth;
    pattern.entries.push_back(
        {static_cast<std::uint32_t>(offset),
         {static_cast<std::uint32_t>(references[0]), static_cast<std::uint32_t>(references[1])},
         static_cast<std::uint32_t>(depth)});
  }
  return r.readable() &&
         r.require(depth_at[period] == 0, "R-FRM-06", "the last frame of a period has depth 0");
}

// 6.14.1 frame_pattern( ). Returns false if elements after it cannot be read.
bool check_frame_pattern(ElementReader& r, FramePattern& pattern) {
  pattern.kind = static_cast<FramePattern::Kind>(r.u(2, "frame_pattern_idc"));
  if (pattern.kind == FramePattern::kDyadic) {
    const std::int64_t period = r.u(3, "pattern_period_log2");
    if (!r.require(period >= 1 && period <= kMaxPatternPeriodLog2, "R-FRM-05",
                   between(1, kMaxPatternPeriodLog2))) {
      return false;
    }
    pattern.period_log2 = static_cast<int>(period);
  } else if (pattern.kind == FramePattern::kExplicit && !check_explicit_pattern(r, pattern)) {
    return false;
  }
  if (!r.readable() || pattern.num_depths() == 1) return r.readable();
  const std::int64_t layers = r.u(3, "temporal_layers_minus1") + 1;
  if (!r.require(layers <= pattern.num_depths(), "R-FRM-07",
                 "the pattern has " + std::to_string(pattern.num_depths()) + " depths")) {
    return false;
  }
  pattern.temporal_layers = static_cast<std::uint32_t>(layers);
  return true;
}

}  // namespace

// 6.14 frames_of_gof( )
bool check_frames(ElementReader& r, const SequenceHeader& header, std::uint32_t num_layers,
                  GofHeaderCheck& gof) {
  const Level& level = header.level();
  FramePattern pattern;
  if (!check_frame_pattern(r, pattern)) return false;
  const bool is_exact = r.u(1, "exact_flag") != 0;
  bool good = true;
  for (std::uint32_t d = 0; !is_exact && d < pattern.num_depths() && r.readable(); ++d) {
    const std::int64_t step = r.ue("frame_step_minus1");
    good &=
        r.require(step < std::int64_t{kMaxInterStep}, "R-FRM-01", at_most(kMaxInterStep - 1));
  }
  (void)r.u(4, "damping_log2");
  (void)r.u(4, "outer_weight");
  (void)r.u(4, "outer_scale");
  if (r.u(1, "learning_flag") != 0) {
    const std::uint64_t vertices = std::uint64_t{header.num_vertices} * pattern.temporal_layers;
    good &= r.require(vertices <= level.max_learning_vertices, "R-LVL-10",
                      level_allows(header.level_idc, level.max_learning_vertices,
                                   " vertices with learned weights, times temporal layers"));
    (void)r.u(4, "prime_log2");
  }
  (void)r.u(1, "frame_hash_flag");
  SliceCounts counts;
  const std::int64_t distance = r.ue("max_earlier_distance");
  const std::uint64_t kept =
      3 * std::uint64_t{header.num_vertices} * static_cast<std::uint64_t>(distance);
  good &= r.require(
      kept <= level.max_gof_factors, "R-LVL-05",
      level_allows(header.level_idc, level.max_gof_factors, " coordinates of earlier frames"));
  counts.frames = gof.num_frames;
  counts.open_end = header.open_end_flag;
  if (!check_layer_groups(r, num_layers, counts.layer_groups)) return false;
  for (std::uint32_t i = 0; !is_exact && i < num_layers; ++i) {
    (void)r.u(4, "layer_step_minus1");
  }
  if (counts.layer_groups == 1) read_rest_order(r);
  const std::int64_t patches = r.ue("num_patches");
  good &= r.require(patches <= std::int64_t{level.max_clusters}, "R-LVL-06",
                    level_allows(header.level_idc, level.max_clusters, " patches"));
  if (gof.num_frames > 0) gof.slices = counts;
  good &= check_alignment(r);
  if (patches == 0) r.expect_end();
  return good && r.readable();
}

// 6.14.2 frame_unit( )
bool check_frame_header(ElementReader& r, const SliceCounts& counts) {
  const std::int64_t frame = r.ue("frame_idx");
  bool good = r.require(frame < counts.frames, "R-FRM-02",
                        "the GOF has " + std::to_string(counts.frames) + " frames");
  // Parsing checks R-FRM-04.
  if (counts.open_end && r.u(1, "gof_end_flag") != 0) return good && r.readable();
  const std::int64_t layers = r.ue("layer_group_idx");
  good &= r.require(layers < counts.layer_groups, "R-FRM-02",
                    "the GOF has " + std::to_string(counts.layer_groups) + " layer groups");
  if (counts.layer_groups == 1) {
    good &= r.require(r.ue("unit_frames_minus1") < std::int64_t{counts.frames}, "R-FRM-09",
                      at_most(counts.frames - 1));
  }
  // Parsing checks whether these frames can follow.
  return good && r.readable();
}

}  // namespace rlpc
