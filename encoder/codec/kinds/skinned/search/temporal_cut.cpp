#include "encoder/codec/kinds/skinned/search/temporal_cut.h"

#include <algorithm>
#include <cstdint>

namespace rlpc {
namespace {

void drop(const SkinnedGof& gof, int layers, int between, TrackResiduals& residuals) {
  if (residuals.empty()) return;
  for (int layer = layers; layer < gof.num_temporal_layers; ++layer) {
    for (const TrackPlace& at : places_of_layer(track_frames(gof), between, layer)) {
      residuals[at.frame] = {};
    }
  }
}

}  // namespace

void set_temporal_layers(int temporal_layers, SkinnedGof& gof) {
  gof.num_temporal_layers = temporal_layers;
  gof.temporal_layers.clear();
  if (temporal_layers == 1) return;
  gof.temporal_layers.assign(gof.slice_layers.size(),
                             static_cast<std::uint32_t>(temporal_layers) - 1);
}

SkinnedGof without_layers(SkinnedGof gof, int layers) {
  for (Bone& bone : gof.bones) {
    drop(gof, layers, bone.rotation_between, bone.rotation_residual);
    drop(gof, layers, bone.origin_between, bone.origin_residual);
    drop(gof, layers, bone.stretch_between, bone.stretch_residual);
  }
  for (Trajectory& trajectory : gof.trajectories) {
    drop(gof, layers, trajectory.temporal_between, trajectory.residual);
  }
  const std::uint32_t left = static_cast<std::uint32_t>(layers) - 1;
  for (std::uint32_t& present : gof.temporal_layers) present = std::min(present, left);
  return gof;
}

}  // namespace rlpc
