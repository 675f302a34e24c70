// Divides a random skinned GOF into a shared rig and a GOF that uses it, for tests.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/testing/random_skinned_gof.h"

namespace rlpc {

// Removes the motion of bones and trajectories, which a shared rig does not have.
inline void remove_motion(SharedRig& rig) {
  for (Bone& bone : rig.bones) {
    Bone still;
    still.parent = bone.parent;
    still.pivot = bone.pivot;
    still.rotation_flag = bone.rotation_flag;
    still.origin_flag = bone.origin_flag;
    still.stretch = bone.stretch;
    still.stretch_axes = bone.stretch_axes;
    bone = still;
  }
  for (Trajectory& t : rig.trajectories) {
    const int spatial_bits = t.spatial_bits;
    t = {};
    t.spatial_bits = spatial_bits;
  }
}

class SplitSkinnedGof {
 public:
  SplitSkinnedGof(unsigned seed, const SkinnedGofSizes& sizes)
      : whole(seed, sizes), state_(seed) {
    whole.header.profile_idc = kProfileHigh;
    const std::uint32_t num_groups = whole.gof.num_component_groups;
    const std::size_t num_rig_groups = random() % (num_groups + 1);
    make_rig(num_rig_groups);
    make_tracks(num_rig_groups);
    if (tracks.trajectories.size() == whole.gof.trajectories.size()) return;
    // Absent tracks count as zero.
    for (std::size_t l = tracks.trajectories.size(); l < whole.gof.trajectories.size(); ++l) {
      make_still(whole.gof.trajectories[l]);
    }
  }

  RandomSkinnedGof whole;  // all component groups in one GOF
  std::uint32_t rig_idx = 0;
  std::shared_ptr<const SharedRig> rig;  // its first component groups
  SkinnedGof tracks;                     // the motion, and the other groups

 private:
  void make_rig(std::size_t num_rig_groups) {
    const SkinnedGof& gof = whole.gof;
    rig_idx = static_cast<std::uint32_t>(random() % kMaxRigs);
    auto made = std::make_shared<SharedRig>(gof);
    made->num_component_groups = static_cast<std::uint32_t>(num_rig_groups);
    made->slice_layers.resize(num_rig_groups + 1);
    made->group_end.resize(std::min(num_rig_groups + 1, gof.group_end.size()));
    made->vertex_residual.resize(std::min(num_rig_groups + 1, gof.vertex_residual.size()));
    made->trajectories.resize(made->group_end.back() - kRestFactors);
    remove_motion(*made);
    rig = std::move(made);
  }

  void make_tracks(std::size_t num_rig_groups) {
    const SkinnedGof& gof = whole.gof;
    const std::size_t with_slices =
        gof.group_end.size();  // groups, including the group of influences
    tracks = gof;
    tracks.kind = GofKind::kSharedRig;
    tracks.rig = rig;
    tracks.rig_idx = rig_idx;
    tracks.num_component_groups = rig->num_component_groups;
    tracks.num_local_groups = gof.num_component_groups - rig->num_component_groups;
    tracks.rest_step = 1;
    tracks.rest = {};
    tracks.counterparts.clear();
    tracks.influences.clear();
    tracks.group_end = {rig->group_end.back()};
    tracks.vertex_residual = {{}};
    for (std::size_t group = num_rig_groups + 1; group < with_slices; ++group) {
      tracks.group_end.push_back(gof.group_end[group]);
      tracks.vertex_residual.push_back(gof.vertex_residual[group]);
    }
    if (with_slices <= num_rig_groups + 1) drop_last_tracks(with_slices);
    for (std::size_t l = 0; l < std::min(rig->trajectories.size(), tracks.trajectories.size());
         ++l) {
      if (random() % 4 != 0) continue;
      Trajectory& t = tracks.trajectories[l];
      const int spatial_bits = t.spatial_bits;
      t = {};
      t.spatial_bits = spatial_bits;
      t.trajectory_flag = false;
      make_still(whole.gof.trajectories[l]);
    }
  }
  // Drops the tracks of some of the last groups of the rig.
  void drop_last_tracks(std::size_t with_slices) {
    std::size_t kept = with_slices;
    while (kept > 1 && random() % 3 == 0) --kept;
    tracks.trajectories.resize(rig->group_end[kept - 1] - kRestFactors);
    for (std::size_t group = kept; group < tracks.slice_layers.size(); ++group) {
      tracks.slice_layers[group] = 0;
      if (!tracks.temporal_layers.empty()) tracks.temporal_layers[group] = 0;
    }
  }
  // Returns random bits by the generator of RandomSkinnedGof.
  std::uint32_t random() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>(state_ >> 33);
  }
  static void make_still(Trajectory& t) {
    t.temporal_predictor = 0;
    t.temporal_weight = {};
    for (Vec3i& residual : t.residual) residual = {};
  }

  std::uint64_t state_;
};

}  // namespace rlpc
