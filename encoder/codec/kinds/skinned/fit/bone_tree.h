// Builds the hierarchy of bones and their joints (after Le and Deng 2014).
#pragma once

#include <cstddef>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/bone_poses.h"
#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"
#include "encoder/codec/spans/rig.h"

namespace rlpc {

struct TreeBone {
  std::size_t bone = 0;  // index in the motions
  int parent = -1;       // index of an earlier element of the tree; -1: root
  Vec3d pivot = Vec3d::Zero();
  bool pinned = false;
};

// A spanning tree, built greedily from the heaviest bone: the next bone is the one that moves
// least relative to a bone in the tree. The pivot of a bone is the point that it and its parent
// move most alike.
//
// The pivot of a pinned bone moves exactly with its parent. A bone is pinned if that raises the
// squared error over the frames by at most `pin_error`.
//
//   motions  [bone][frame]; those of pinned bones are changed accordingly
std::vector<TreeBone> build_bone_tree(const SkinMoments& moments, double pin_error,
                                      std::vector<std::vector<Motion>>& motions);

// Gives a rig, which has rest positions and weights, the bones of a tree. The weights refer to
// motions, then to the bones. Quaternions keep their sign from frame to frame.
void put_in_tree(const std::vector<TreeBone>& tree,
                 const std::vector<std::vector<Motion>>& motions, Rig& rig);

}  // namespace rlpc
