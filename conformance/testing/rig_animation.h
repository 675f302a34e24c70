// Small streams of the High profile with all syntax of shared rigs; residuals are noise.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/codec/kinds/skinned/recon/rig_recon.h"
#include "conformance/testing/sliced_animation.h"

namespace rlpc {

class RigAnimation : protected SlicedAnimation {
 public:
  RigAnimation() { header_.profile_idc = kProfileHigh; }

  // Has shared rigs with and without vertex layers, one that is incomplete and one that is
  // replaced; GOFs that use all of a rig, add local component groups to it, or use a part of
  // it; GOFs of the other kinds; two frames each.
  StreamBytes stream(bool with_index) {
    out_ = lead(8);
    add_rig(0, make_rig(Prediction::kLayers, kGroups));
    add_tracks(0, kGroups, 2);
    add_rig(5, make_rig(Prediction::kParallelogram, 1));
    add_tracks(5, 1, 0);
    add_tracks(0, kGroups, 0);
    add_gof(clusters(first_frame()));
    add_tracks(0, 1, 0);
    add_gof(gof(first_frame(), Prediction::kLayers));
    add_rig(0, make_rig(Prediction::kNone, kGroups));
    add_tracks(0, 0, 0);
    add_tracks(0, kGroups, 1);
    return finish(with_index);
  }
  // Has a rig that no GOF uses before it is replaced; and one with a bone that moves no vertex,
  // and a trajectory that no GOF has.
  StreamBytes idle_stream() {
    out_ = lead(1);
    add_rig(7, make_rig(Prediction::kNone, kGroups));
    SharedRig rig = make_rig(Prediction::kLayers, kGroups);
    rig.bones.push_back(bone(3));
    strip(rig.bones.back());
    add_rig(7, rig);
    SkinnedGof gof = make_tracks(7, kGroups, 0);
    gof.trajectories.back() = {};
    gof.trajectories.back().trajectory_flag = false;
    add_gof(gof);
    return finish(false);
  }
  // Has a rig for each GOF; rig indices take turns.
  StreamBytes many_rigs(std::uint32_t count) {
    out_ = lead(count);
    for (std::uint32_t g = 0; g < count; ++g) {
      add_rig(g % kMaxRigs, make_rig(Prediction::kLayers, kGroups));
      add_tracks(g % kMaxRigs, kGroups, 0);
    }
    return finish(true);
  }

 private:
  struct Kept {
    std::shared_ptr<const SharedRig> rig;
    std::shared_ptr<const RigRecon> recon;
  };

  std::uint32_t first_frame() const {
    return static_cast<std::uint32_t>(index_.gofs.size()) * kGofFrames;
  }
  const OrderedMesh& mesh(Prediction prediction) {
    auto& mesh = meshes_.at(static_cast<std::size_t>(prediction));
    if (!mesh) mesh = std::make_unique<OrderedMesh>(prediction, topology_, layers_);
    return *mesh;
  }
  static void strip(Bone& bone) {
    bone.rotation_residual.clear();
    bone.origin_residual.clear();
  }

  // num_groups: number of component groups that have slices.
  SharedRig make_rig(Prediction prediction, std::uint32_t num_groups) {
    SharedRig rig = gof(0, prediction);
    for (Bone& bone : rig.bones) strip(bone);
    if (prediction == Prediction::kLayers) rig.weights.num_adaptive_factors = 4;
    rig.group_end.resize(num_groups + 1);
    rig.vertex_residual.resize(num_groups + 1);
    rig.trajectories.resize(rig.group_end.back() - kRestFactors);
    for (std::size_t group = num_groups + 1; group <= kGroups; ++group) {
      rig.slice_layers[group] = 0;
    }
    for (Trajectory& t : rig.trajectories) {
      const int spatial_bits = t.spatial_bits;
      t = {};
      t.spatial_bits = spatial_bits;
    }
    return rig;
  }
  // num_groups: number of component groups of the rig that have tracks.
  SkinnedGof make_tracks(std::uint32_t rig_idx, std::uint32_t num_groups,
                         std::uint32_t num_local_groups) {
    const auto& rig = kept_.at(rig_idx).rig;
    SkinnedGof gof;
    static_cast<SharedRig&>(gof) = *rig;
    gof.kind = GofKind::kSharedRig;
    gof.first_frame = first_frame();
    gof.num_frames = kGofFrames;
    gof.rig = rig;
    gof.rig_idx = rig_idx;
    gof.num_local_groups = num_local_groups;
    gof.influences.clear();
    for (Bone& bone : gof.bones) {
      if (bone.rotation_flag) bone.rotation_residual = track();
      if (bone.origin_flag) bone.origin_residual = track();
    }
    gof.trajectories.clear();
    for (std::size_t l = 0; l < rig->group_end[num_groups] - kRestFactors; ++l) {
      const bool occurs = l != 1 || index_.gofs.size() % 3 != 2;
      Trajectory next = occurs ? trajectory(3 + l) : Trajectory();
      next.trajectory_flag = occurs;
      next.spatial_bits = rig->trajectories[l].spatial_bits;
      gof.trajectories.push_back(next);
    }
    for (std::size_t group = num_groups + 1; group <= gof.num_component_groups; ++group) {
      gof.slice_layers[group] = 0;
    }
    gof.group_end = {rig->group_end.back()};
    gof.vertex_residual = {{}};
    for (std::uint32_t group = 1; group <= num_local_groups; ++group) {
      for (std::uint32_t l = 0; l < group; ++l) gof.trajectories.push_back(trajectory(group));
      gof.group_end.push_back(kRestFactors + gof.trajectories.size());
      gof.vertex_residual.push_back(vertex_residuals(group, 4));
      gof.slice_layers.push_back(static_cast<std::uint32_t>(gof.layer_group_size.size()));
    }
    return gof;
  }

  void add_rig(std::uint32_t rig_idx, const SharedRig& rig) {
    index_.rigs.push_back({rig_idx, out_.size()});
    const OrderedMesh& coded = mesh(rig.prediction);
    const SkinnedGofPayloads payloads = write_shared_rig(rig, rig_idx, coded, header_);
    append(out_, UnitType::kRig, payloads.first);
    for (const Bytes& slice : payloads.slices) append(out_, UnitType::kSlice, slice);
    kept_.at(rig_idx) = {std::make_shared<SharedRig>(rig),
                         std::make_shared<RigRecon>(coded, rig, header_.position_bits, true)};
  }
  void add_tracks(std::uint32_t rig_idx, std::uint32_t num_groups,
                  std::uint32_t num_local_groups) {
    add_gof(make_tracks(rig_idx, num_groups, num_local_groups));
  }
  template <class Gof>
  void add_gof(const Gof& gof) {
    if (index_.gofs.empty()) {
      index_.first_gof_offset = out_.size();
    } else {
      index_.gofs.back().bytes = out_.size() - gof_offset_;
    }
    gof_offset_ = out_.size();
    append_any(gof);
    index_.gofs.push_back({kGofFrames, out_.size() - gof_offset_});
  }
  void append_any(const ClusterGof& gof) { append_gof(out_, gof); }
  void append_any(const SkinnedGof& gof) {
    if (!gof.rig) return append_gof(out_, gof);
    const SkinnedGofPayloads payloads = write_tracks(gof, mesh(gof.prediction), header_);
    append(out_, UnitType::kGof, payloads.first);
    for (const Bytes& slice : payloads.slices) append(out_, UnitType::kSlice, slice);
    const SkinnedRecon recon(kept_.at(gof.rig_idx).recon, gof);
    append(out_, UnitType::kGofHash, write_gof_hash(hashes(recon), true));
  }
  StreamBytes finish(bool with_index) {
    std::uint32_t index_distance = 0;
    if (with_index) {
      const Bytes unit = write_unit(UnitType::kGofIndex, write_gof_index(index_, kProfileHigh));
      out_.insert(out_.end(), unit.begin(), unit.end());
      index_distance = static_cast<std::uint32_t>(unit.size());
    }
    append(out_, UnitType::kEndOfSequence, write_end_of_sequence(index_distance));
    return std::move(out_);
  }

  StreamBytes out_;
  GofIndexEntries index_;
  std::uint64_t gof_offset_ = 0;
  std::array<std::unique_ptr<OrderedMesh>, 4> meshes_;
  std::array<Kept, kMaxRigs> kept_;
};

inline StreamBytes rig_stream() { return RigAnimation().stream(false); }
inline StreamBytes indexed_rig_stream() { return RigAnimation().stream(true); }

}  // namespace rlpc
