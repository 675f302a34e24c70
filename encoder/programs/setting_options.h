// Options for the settings of the encoder: EncoderSettings, FrameFormat, InputOptions.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "common/cli/setting_options.h"

namespace rlpc {

inline constexpr std::array kEncoderOptions = std::to_array<SettingOption>({
    {"profile", "--profile"},
    {"target = kg", "--quality, --kg"},
    {"max_normals", "--normals"},
    {"target = bpvf", "--bpvf"},
    {"target = max_error", "--max-error"},
    {"target = lossless", "--lossless"},
    {"target = lossless, target_value = BITS", "--lossless BITS"},
    {"preset", "--preset"},
    {"gof_kind", "--gof-kind"},
    {"gof_frames", "--gof"},
    {"components", "--components"},
    {"low_delay", "--low-delay"},
    {"clips", "--clip"},
    {"max_memory_bytes", "--max-memory"},
    {"partition", "--partition"},
    // Baseline profile.
    {"clusters", "--clusters"},
    {"rdo = false", "--no-rdo"},
    {"rate_in_vectors", "--rdo-rate"},
    {"qu", "--qu"},
    {"qc", "--qc"},
    {"qdelta", "--qdelta"},
    {"frame_mode", "--frame"},
    {"seed_mode", "--seeds"},
    {"motion", "--motion"},
    // Main and High profiles.
    {"bones", "--bones"},
    {"prediction", "--prediction"},
    {"influences", "--influences"},
    {"geometry_weights = false", "--no-geometry-weights"},
    {"outer_ring = false", "--no-outer-ring"},
    {"layer_steps = false", "--no-layer-steps"},
    {"temporal_weights = false", "--no-temporal-weights"},
    {"cobra_steps", "--basis-steps"},
    {"clusters = false", "--no-clusters"},
    {"component_groups", "--component-groups"},
    {"layer_groups", "--layer-groups"},
    {"layer_cuts", "--layer-cuts"},
    {"adaptive_factors", "--adaptive-factors"},
    {"rest", "--rest"},
    {"track_levels", "--track-levels"},
    {"temporal_layers", "--temporal-layers"},
    // Inter GOFs.
    {"pattern", "--frame-pattern"},
    {"weights", "--frame-weights"},
    {"patches", "--patches"},
    // Input.
    {"points", "--points"},
    {"frame_rate", "--fps"},
    {"animations", "--animation"},
    {"weld = false", "--no-weld"},
});

// Returns a message of the encoder for users of rlpcenc and rlpccmp, with options in place of
// settings.
inline std::string with_encoder_options(std::string_view message) {
  return with_options(message, kEncoderOptions);
}

}  // namespace rlpc
