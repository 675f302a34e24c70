// The rig of a GOF as the analysis finds it, before quantisation: a skinned mesh that
// approximates the motion of the frames.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rlpc {

using Point = std::array<double, 3>;  // grid units

struct RigPose {
  std::array<double, 4> rotation{1.0, 0.0, 0.0, 0.0};  // relative to the rest shape; w, x, y, z
  Point origin{};                                      // position of the pivot
};

struct RigBone {
  std::int32_t parent = -1;    // index of an earlier bone; -1: root
  Point pivot{};               // in the rest shape
  bool rotates = true;         // relative to its parent
  bool pinned = false;         // its pivot moves with the parent
  std::vector<RigPose> poses;  // [num_frames]
};

// Negates a quaternion if that is nearer to the one before it: both signs are one rotation, but
// tracks are smooth in one of them.
inline void keep_sign(const std::array<double, 4>& before, std::array<double, 4>& rotation) {
  double same = 0.0;
  for (std::size_t k = 0; k < 4; ++k) same += before[k] * rotation[k];
  if (same < 0.0) {
    for (double& q : rotation) q = -q;
  }
}

struct RigWeight {
  std::uint32_t bone = 0;
  double weight = 1.0;
};

struct Rig {
  std::vector<RigBone> bones;
  std::vector<std::vector<RigWeight>> weights;  // [num_vertices]; sum 1 for each vertex
  std::vector<Point> rest;                      // [num_vertices]
};

}  // namespace rlpc
