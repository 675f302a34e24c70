#include "encoder/skinned_gof/search/tool_search.h"

#include <utility>

namespace rlpc {
namespace {

// tuned (off: 0): Meshes of at most this many vertices are encoded with every prediction along
// the mesh, as with the slow preset. Parallelograms predict some of them much better than
// layers, and the time is short.
constexpr std::uint32_t kSmallMesh = 1000;

}  // namespace

// Geometry weights do not pay off if the rest positions say little about the motion.
// Parallelograms predict small regular meshes better. If the residual of bone motion is small,
// rest positions cost less without layers.
SkinnedTrial search_tools(const SkinnedContext& context, const SkinnedTrials& trials,
                          SkinnedTrial best) {
  const MainTools& tools = context.settings.main;
  const auto try_other = [&](auto SkinnedSettings::*member, auto value) {
    SkinnedSettings other = best.candidate.settings;
    if (other.*member == value) return;
    other.*member = value;
    best = trials.with_settings(std::move(best), other);
  };
  const bool thorough =
      context.settings.preset == Preset::kSlow || context.header.num_vertices <= kSmallMesh;
  if (best.candidate.settings.prediction == Prediction::kLayers) {
    if (tools.geometry_weights) try_other(&SkinnedSettings::damping_log2, 0);
    if (tools.layer_steps && thorough) try_other(&SkinnedSettings::layer_steps, false);
  }
  const bool any_prediction = !tools.prediction && tools.layer_groups <= 1;
  if (any_prediction && best.candidate.rig.bones.size() > 1) {
    try_other(&SkinnedSettings::prediction, Prediction::kNone);
  }
  if (any_prediction && thorough) {
    try_other(&SkinnedSettings::prediction, Prediction::kParallelogram);
    try_other(&SkinnedSettings::prediction, Prediction::kParallelograms);
  }
  return best;
}

}  // namespace rlpc
