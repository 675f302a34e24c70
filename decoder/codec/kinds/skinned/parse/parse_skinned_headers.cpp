#include "decoder/codec/kinds/skinned/parse/parse_skinned_headers.h"

#include "decoder/codec/parse/parse_layers.h"
#include "decoder/codec/parse/parse_rest_residuals.h"

namespace rlpc {
namespace {

// 6.11 layers_of_rig( )
void parse_layers(BitReader& r, const SequenceHeader& header, std::uint32_t num_layers,
                  SharedRig& rig) {
  rig.weights.damping_log2 = static_cast<int>(r.u(4, "damping_log2"));
  rig.weights.outer_weight = static_cast<int>(r.u(4, "outer_weight"));
  rig.weights.outer_scale = static_cast<int>(r.u(4, "outer_scale"));
  if (header.profile_idc >= kProfileHigh) {
    const std::uint64_t at = r.bit_pos();
    rig.weights.num_adaptive_factors =
        r.ue("num_adaptive_factors", {0, header.level().max_components}, "R-BON-06");
    const std::uint64_t adaptive_values =
        std::uint64_t{rig.weights.num_adaptive_factors} * header.num_vertices;
    r.require({"num_adaptive_factors", rig.weights.num_adaptive_factors, at},
              adaptive_values <= header.level().max_adaptive_values, "R-LVL-09");
  }
  rig.layer_group_size = parse_layer_groups(r, num_layers);
  if (r.stopped()) return;
  rig.layer_step.resize(num_layers);
  parse_layer_steps(r, rig.layer_step);
}

}  // namespace

std::uint32_t parse_rig_idx(BitReader& r) { return r.u(3, "rig_idx"); }

// 6.11 rig_header( )
std::uint32_t parse_rig_header(BitReader& r, const SequenceHeader& header,
                               std::uint32_t num_layers, SharedRig& rig) {
  const Level& level = header.level();
  const std::uint32_t num_bones =
      r.ue("num_bones_minus1", {0, std::int64_t{level.max_clusters} - 1}, "R-LVL-06") + 1;
  rig.fraction_bits =
      static_cast<int>(r.u(5, "fraction_bits", {0, kMaxFractionBits}, "R-GOF-03"));
  rig.weight_bits = static_cast<int>(r.u(3, "weight_bits"));
  rig.rest_step = r.ue("rest_step_minus1", {0, kMaxRestStep - 1}, "R-BON-01") + 1;
  rig.num_component_groups = r.ue("num_component_groups", {0, kMaxComponentGroups}, "R-BON-02");
  rig.prediction = static_cast<Prediction>(r.u(2, "prediction_idc"));
  if (rig.prediction == Prediction::kLayers) parse_layers(r, header, num_layers, rig);
  if (header.profile_idc >= kProfileHigh) {
    rig.stretch_flag = r.flag("stretch_flag");
    rig.rest = parse_rest_settings(r, false);
  }
  r.byte_alignment();
  return num_bones;
}

// 6.11 levels_of_tracks( )
void parse_levels_of_tracks(BitReader& r, SkinnedGof& gof) {
  gof.track_levels = static_cast<int>(r.u(3, "track_levels"));
  if (gof.track_levels == 0) return;
  gof.num_temporal_layers = static_cast<int>(r.u(3, "num_temporal_layers_minus1",
                                                 {0, gof.track_levels}, "R-TRK-01")) +
                            1;
}

// 6.13.1 tracks_of_gof( )
void parse_tracks_header(BitReader& r, std::uint32_t rig_groups, SkinnedGof& gof) {
  parse_levels_of_tracks(r, gof);
  gof.num_local_groups =
      r.ue("num_local_groups", {0, std::int64_t{kMaxComponentGroups} - rig_groups}, "R-BON-02");
}

// 6.12 slice_unit( ), up to its section
SliceEntry parse_slice_header(BitReader& r, const SliceCounts& counts) {
  SliceEntry slice;
  if (counts.temporal_layers > 1) {
    slice.temporal_layer_idx =
        r.u(3, "temporal_layer_idx", {0, std::int64_t{counts.temporal_layers} - 1}, "R-SLI-01");
  }
  slice.component_group_idx =
      r.ue("component_group_idx", {0, counts.component_groups}, "R-SLI-01");
  if (slice.temporal_layer_idx == 0) {
    slice.layer_group_idx =
        r.ue("layer_group_idx", {0, std::int64_t{counts.layer_groups} - 1}, "R-SLI-01");
  }
  return slice;
}

}  // namespace rlpc
