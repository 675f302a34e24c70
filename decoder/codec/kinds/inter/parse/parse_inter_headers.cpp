#include "decoder/codec/kinds/inter/parse/parse_inter_headers.h"

#include "decoder/codec/kinds/inter/parse/parse_frame_pattern.h"
#include "decoder/codec/parse/parse_layers.h"
#include "decoder/codec/parse/parse_rest_residuals.h"

namespace rlpc {
namespace {

// 6.14 frames_of_gof( ): the settings of weights
void parse_weights(BitReader& r, const SequenceHeader& header, InterSettings& settings) {
  settings.weights.damping_log2 = static_cast<int>(r.u(4, "damping_log2"));
  settings.weights.outer_weight = static_cast<int>(r.u(4, "outer_weight"));
  settings.weights.outer_scale = static_cast<int>(r.u(4, "outer_scale"));
  const std::uint64_t at = r.bit_pos();
  settings.learning_flag = r.flag("learning_flag");
  if (!settings.learning_flag) return;
  const std::uint64_t vertices =
      std::uint64_t{header.num_vertices} * settings.pattern.temporal_layers;
  r.require({"learning_flag", 1, at}, vertices <= header.level().max_learning_vertices,
            "R-LVL-10");
  settings.prime_log2 = static_cast<int>(r.u(4, "prime_log2"));
}

}  // namespace

// 6.14 frames_of_gof( )
void parse_inter_settings(BitReader& r, const SequenceHeader& header, std::uint32_t num_layers,
                          InterSettings& settings) {
  settings.pattern = parse_frame_pattern(r);
  if (r.stopped()) return;
  settings.exact_flag = r.flag("exact_flag");
  settings.step.assign(settings.pattern.num_depths(), kExactInterStep);
  for (std::uint32_t& step : settings.step) {
    if (settings.exact_flag) break;
    step = r.ue("frame_step_minus1", {0, std::int64_t{kMaxInterStep} - 1}, "R-FRM-01") + 1;
  }
  parse_weights(r, header, settings);
  settings.frame_hash_flag = r.flag("frame_hash_flag");
  const std::uint64_t values = 3 * std::uint64_t{header.num_vertices};
  const auto max_distance = static_cast<std::int64_t>(header.level().max_gof_factors / values);
  settings.max_earlier_distance = r.ue("max_earlier_distance", {0, max_distance}, "R-LVL-05");
  settings.layer_group_size = parse_layer_groups(r, num_layers);
  if (r.stopped()) return;
  settings.layer_step.assign(num_layers, kMaxLayerStep);
  if (!settings.exact_flag) parse_layer_steps(r, settings.layer_step);
  settings.rest = parse_rest_settings(r, settings.exact_flag);
  if (!settings.exact_flag) {
    settings.first_step =
        r.ue("rest_step_minus1", {0, std::int64_t{kMaxInterStep} - 1}, "R-FRM-01") + 1;
    settings.step_delta_flag = r.flag("frame_step_delta_flag");
  }
  settings.num_patches =
      r.ue("num_patches", {0, std::int64_t{header.level().max_clusters}}, "R-LVL-06");
  r.byte_alignment();
  if (settings.num_patches == 0) r.expect_end();
}

FrameUnitStart parse_frame_unit_start(BitReader& r, const SequenceHeader& header,
                                      std::uint32_t num_frames) {
  FrameUnitStart start;
  start.frame_idx = r.ue("frame_idx", {0, std::int64_t{num_frames} - 1}, "R-FRM-02");
  if (header.open_end_flag) start.gof_end_flag = r.flag("gof_end_flag");
  return start;
}

// 6.14.2 frame_unit( ) and frames_of_group( )
FrameUnitStart parse_frame_unit_header(BitReader& r, const SequenceHeader& header,
                                       const FrameCounts& counts) {
  FrameUnitStart start = parse_frame_unit_start(r, header, counts.frames);
  if (start.gof_end_flag) return start;
  const std::int64_t num_groups = counts.layer_groups;
  start.layer_group_idx = r.ue("layer_group_idx", {0, num_groups - 1}, "R-FRM-02");
  const std::int64_t max_minus1 = std::int64_t{counts.frames} - 1;
  const std::uint64_t at = r.bit_pos();
  start.unit_frames_minus1 = {"unit_frames_minus1", 0, at};
  start.unit_frames_minus1.value = r.ue("unit_frames_minus1", {0, max_minus1}, "R-FRM-09");
  return start;
}

}  // namespace rlpc
