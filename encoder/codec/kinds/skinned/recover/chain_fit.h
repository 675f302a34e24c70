// Fits bones whose rotations are known, and the skin of a mesh, to its trajectories.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_chains.h"
#include "encoder/codec/kinds/skinned/recover/placed_bones.h"
#include "encoder/codec/kinds/skinned/recover/skin_vertex.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"

namespace rlpc {

struct Skin {
  std::vector<Vec3d> rest;                      // [vertex], extents
  std::vector<std::vector<RigWeight>> weights;  // [vertex], in no order
  std::size_t num_exact = 0;                    // vertices that bones move exactly
};

// Places the bones by damped Gauss-Newton steps, from which the rest positions and weights of a
// sample of the vertices have been eliminated. Vertices that are explained badly are offered
// more bones in between. Then fits all vertices.
//
//   chains  those that the bones are made of
//   bones   where to start; moved
Skin fit_chains(const Trajectories& trajectories, const BoneChains& chains, PlacedBones& bones);

}  // namespace rlpc
