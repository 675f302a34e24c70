// Which bone hangs from which, and where (after Le and Deng 2014).
#pragma once

#include <cstddef>
#include <vector>

#include "encoder/skinned_gof/fit/bone_poses.h"
#include "encoder/skinned_gof/fit/rigid_motion.h"

namespace rlpc {

struct TreeBone {
  std::size_t bone = 0;  // as numbered in the motions
  int parent = -1;       // position in the tree, before this one
  Vec3d pivot = Vec3d::Zero();
  bool pinned = false;
};

// A spanning tree that starts at the heaviest bone and takes next the bone that stays closest,
// over the frames, to one already in the tree. The pivot is the point that both move alike.
//
// A pinned bone keeps its pivot where the parent carries it: `motions` of pinned bones, [bone]
// [frame], are changed to obey exactly. A bone is pinned if that raises the squared error over
// the frames by less than `pin_error`.
std::vector<TreeBone> build_bone_tree(const SkinMoments& moments, double pin_error,
                                      std::vector<std::vector<Motion>>& motions);

}  // namespace rlpc
