// A skinned mesh that moves nearly as a group of frames does: what the analysis finds, before
// quantisation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace rlpc {

using Point = std::array<double, 3>;  // grid units

struct RigPose {
  std::array<double, 4> rotation{1.0, 0.0, 0.0, 0.0};  // of the rest shape; w, x, y, z
  Point origin{};                                      // where the pivot goes
};

struct RigBone {
  std::int32_t parent = -1;    // a bone before
  Point pivot{};               // in the rest shape
  bool turns = true;           // relative to its parent
  bool pinned = false;         // the parent takes the pivot where it goes
  std::vector<RigPose> poses;  // [num_frames]
};

struct RigWeight {
  std::uint32_t bone = 0;
  double weight = 1.0;
};

struct Rig {
  std::vector<RigBone> bones;
  std::vector<std::vector<RigWeight>> weights;  // [num_vertices]; those of a vertex sum to 1
  std::vector<Point> rest;                      // [num_vertices]
};

}  // namespace rlpc
