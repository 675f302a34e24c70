// Animation of one property of one node: keys and their interpolation.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "encoder/input/gltf/document/affine.h"
#include "encoder/input/gltf/document/document.h"

namespace rlpc {

struct GltfTrack {
  GltfInterpolation interpolation = GltfInterpolation::kLinear;
  std::size_t width = 0;      // numbers of a value
  std::vector<float> times;   // seconds, ascending, at least one
  std::vector<float> values;  // per time `width`; cubic: in-tangent, value, out-tangent
};

// The value is held before the first key and after the last. out: [width].
void sample(const GltfTrack& track, double time, std::span<double> out);

// A unit quaternion from a track of unit quaternions: linear means spherical, the shorter way
// round.
GltfQuaternion sample_rotation(const GltfTrack& track, double time);

// Of any length; 0 yields no rotation.
GltfQuaternion unit_quaternion(const GltfQuaternion& q);

}  // namespace rlpc
