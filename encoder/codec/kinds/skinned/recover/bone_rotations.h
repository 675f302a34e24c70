// Finds the rotations of the bones that a mesh was skinned with, from its trajectories alone.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/vertex_rings.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"
#include "encoder/codec/kinds/skinned/recover/trajectory_span.h"

namespace rlpc {

struct BoneRotation {
  Rotations rotation;                   // the identity in the first frame
  std::vector<std::uint32_t> vertices;  // of the patch in whose span it was found
  std::vector<Vec3d> combination;       // TrajectorySpan::Found, for these vertices
  double error = 0.0;
};

struct BoneRotations {
  std::vector<BoneRotation> bones;
  double explained = 0.0;  // part of the patches that move along the columns of the rotations
};

// Searches patches of growing size for rotations, as long as those found before do not explain
// how the patches move. Ends soon where the mesh was not skinned, or not with rigid bones, or
// where its numbers are not as exact as floats: then it finds none.
BoneRotations find_bone_rotations(const Trajectories& trajectories, const VertexRings& rings);

// Directions along which a patch moves less, in extents, are left out.
inline constexpr double kExactMotion = 3e-7;  // fixed: several times the rounding of floats
// What explains motion to within this, in extents, is exact.
inline constexpr double kExplained = 1e-5;  // fixed: a hundredth of the error at KG 0.1 %

}  // namespace rlpc
