// The rig of a GOF as the analysis finds it, before quantisation: a skinned mesh that
// approximates the motion of the frames.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/kinds/skinned/skinned_gof.h"

namespace rlpc {

using Point = std::array<double, 3>;      // grid units
using AxisImages = std::array<Point, 3>;  // images of the x, y and z axes under a linear map

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
  // A bone that stretches by itself (8.12.5), and the rotation, w, x, y, z, that turns the axes
  // of the rest shape to those along which it does.
  Stretch stretch = Stretch::kNone;
  std::array<double, 4> stretch_turn{1.0, 0.0, 0.0, 0.0};
  // [num_frames]: what the bone makes of the axes of the rest shape, if it or one above it
  // stretches; otherwise empty: rotations.
  std::vector<AxisImages> axes;
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

  // Returns whether any bone stretches.
  bool stretches() const {
    return std::any_of(bones.begin(), bones.end(),
                       [](const RigBone& bone) { return bone.stretch != Stretch::kNone; });
  }
};

}  // namespace rlpc
