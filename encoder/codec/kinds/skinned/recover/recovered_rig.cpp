#include "encoder/codec/kinds/skinned/recover/recovered_rig.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/bone_poses.h"
#include "encoder/codec/kinds/skinned/fit/bone_tree.h"
#include "encoder/codec/kinds/skinned/fit/skin_sums.h"
#include "encoder/codec/kinds/skinned/fit/vertex_rings.h"
#include "encoder/codec/kinds/skinned/recover/bone_chains.h"
#include "encoder/codec/kinds/skinned/recover/bone_placement.h"
#include "encoder/codec/kinds/skinned/recover/bone_rotations.h"
#include "encoder/codec/kinds/skinned/recover/bone_space.h"
#include "encoder/codec/kinds/skinned/recover/chain_fit.h"
#include "encoder/codec/kinds/skinned/recover/placed_bones.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {
namespace {

Vec3d position(const SpanFrames& frames, std::uint32_t frame, std::uint32_t vertex) {
  const double* p = frames.at(frame, vertex);
  return {p[0], p[1], p[2]};
}

// Returns the rotation of a bone in a frame, near another one.
Eigen::Matrix3d rotation_in(const SpanFrames& frames, std::uint32_t frame,
                            const BoneRotation& bone, const Eigen::Matrix3d& near) {
  Vec3d mean = Vec3d::Zero();
  for (const std::uint32_t v : bone.vertices) {
    mean += position(frames, frame, v) / static_cast<double>(bone.vertices.size());
  }
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < bone.vertices.size(); ++i) {
    sum += (position(frames, frame, bone.vertices[i]) - mean) * bone.combination[i].transpose();
  }
  return closest_rotation(sum, near);
}

// Returns the motions of bones in all frames of a span, in grid units; none for a bone without
// a place.
BoneMotions motions_of(const SpanFrames& frames, double extent, const BoneRotations& rotations,
                       const BoneChains& chains, const PlacedBones& bones) {
  BoneMotions motions(chains.bones.size());
  for (const std::size_t b : bones.space().order()) {
    const BoneChains::Bone& bone = chains.bones[b];
    const Vec3d pivot = bones.pivot(b) * extent;
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
      rotation = rotation_in(frames, f, rotations.bones[b], rotation);
      Vec3d origin = Vec3d::Zero();
      if (bone.anchors.empty()) {
        origin = moved(motions[bones.space().parent(b)][f], pivot);
      } else {
        for (const std::uint32_t v : bone.anchors) origin += position(frames, f, v);
        origin /= static_cast<double>(bone.anchors.size());
      }
      Motion m;
      m.leftCols<3>() = rotation * bones.turn(b);
      m.col(3) = origin - m.leftCols<3>() * pivot;
      motions[b].push_back(m);
    }
  }
  return motions;
}

}  // namespace

std::optional<RecoveredRig> recover_rig(const SpanFrames& frames,
                                        std::span<const Triangle> triangles) {
  const Stage stage("rig recovery");
  // tuned: Frames that bones are looked for in. More tell little, and take time in proportion.
  constexpr std::uint32_t kFrames = 96;
  constexpr std::uint32_t kFew = 16;      // fixed: fewer do not tell rotations apart
  constexpr double kMinExplained = 0.75;  // fixed: of the patches; less does not lead to a rig
  if (frames.num_frames < kFew || frames.num_vertices == 0) return std::nullopt;
  const Trajectories t(frames, kFrames);
  if (!(t.extent() > 0.0)) return std::nullopt;
  const VertexRings rings = vertex_rings(frames.num_vertices, triangles);
  BoneRotations rotations = find_bone_rotations(t, rings);
  if (rotations.bones.size() < 2 || rotations.explained < kMinExplained) return std::nullopt;
  const BoneChains chains = connect_bones(t, rings, rotations);
  if (chains.order.size() < 2) return std::nullopt;
  BoneSpace space(t, rotations, chains);
  PlacedBones bones(space, chains);
  place_bones(t, chains, space, bones);
  Skin skin = fit_chains(t, chains, bones);

  BoneMotions placed = motions_of(frames, t.extent(), rotations, chains, bones);
  BoneMotions motions;
  std::vector<std::uint32_t> place(placed.size());
  for (const std::size_t b : bones.space().order()) {
    place[b] = static_cast<std::uint32_t>(motions.size());
    motions.push_back(std::move(placed[b]));
  }
  SkinMoments moments(motions.size());
  for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
    skin.rest[v] *= t.extent();
    for (RigWeight& w : skin.weights[v]) w.bone = place[w.bone];
    moments.add(skin.rest[v], skin.weights[v]);
  }
  const std::vector<TreeBone> tree = build_bone_tree(moments, 0.0, motions);
  RecoveredRig result{{}, static_cast<double>(skin.num_exact) / frames.num_vertices};
  for (const Vec3d& p : skin.rest) result.rig.rest.push_back({p(0), p(1), p(2)});
  for (auto& weights : skin.weights) {
    std::stable_sort(
        weights.begin(), weights.end(),
        [](const RigWeight& a, const RigWeight& b) { return a.weight > b.weight; });
  }
  result.rig.weights = std::move(skin.weights);
  put_in_tree(tree, motions, result.rig);
  return result;
}

}  // namespace rlpc
