// How bones with known rotations are connected: which vertices each may move, where its origin
// is known, and from which other bone it hangs where it is not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/vertex_rings.h"
#include "encoder/codec/kinds/skinned/recover/bone_rotations.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"

namespace rlpc {

struct BoneChains {
  static constexpr std::size_t kNone = ~std::size_t{0};  // fixed: no index

  struct Bone {
    // Vertices that follow this bone alone; its pivot is their mean. Empty: there are none, and
    // the pivot moves with the parent.
    std::vector<std::uint32_t> anchors;
    std::size_t parent = kNone;   // of a bone without anchors; kNone: it has no place
    Vec3d pivot = Vec3d::Zero();  // in the first frame; a guess if there are no anchors
  };
  // A point that moves with two anchored bones.
  struct Joint {
    std::size_t first = 0;
    std::size_t second = 0;
    Vec3d at = Vec3d::Zero();  // in the first frame
  };
  std::vector<Bone> bones;
  std::vector<std::size_t> order;  // of the bones that have a place, parents first
  std::vector<Joint> joints;       // without circles
  // [vertex]: bones that it may follow, ascending.
  std::vector<std::vector<std::uint32_t>> candidates;
};

// A vertex may follow the bones whose rotations are in the span of a patch around it, and those
// of its neighbours. A bone without anchors hangs from the one that it shares most patches
// with. Bones that turn alike and move apart, as their anchors show, are added to the
// rotations.
//
// Looks at a sample of the vertices, and gives the others the bones of those nearest to them.
BoneChains connect_bones(const Trajectories& trajectories, const VertexRings& rings,
                         BoneRotations& rotations);

}  // namespace rlpc
