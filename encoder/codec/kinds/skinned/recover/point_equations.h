// The equations of a step of the bones, from one point of the rest shape.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_space.h"
#include "encoder/codec/kinds/skinned/recover/placed_bones.h"
#include "encoder/codec/spans/rig.h"

namespace rlpc {

// A point of the rest shape that follows bones with some weights, and what it should move like.
struct FollowingPoint {
  const BoneSpace::Part& part;
  std::span<const RigWeight> weights;  // at least one
  Vec3d rest;
  std::span<const double> wanted;  // SkinVertex::wanted(); empty: it should not move
  bool weights_vary = false;       // so that their sum stays
};

// Normal equations for some unknowns of the bones, counted as in PlacedBones::move().
struct StepEquations {
  std::vector<std::size_t> unknowns;
  std::vector<double> a;  // [count][count]
  std::vector<double> b;  // [count]
};

// Returns the equations of a point from which its rest position, and its weights if they vary,
// have been eliminated.
StepEquations point_equations(const PlacedBones& bones, const FollowingPoint& point);

}  // namespace rlpc
