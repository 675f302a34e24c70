// Animation of one property of one node: values at times, and what is between them.
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

// Before the first time and after the last, the value stays. out: [width].
void sample(const GltfTrack& track, double time, std::span<double> out);

// Of a track of unit quaternions, a unit quaternion: linear is spherical, the shorter way
// round.
GltfQuaternion sample_rotation(const GltfTrack& track, double time);

// Of any length but 0, which gives no rotation.
GltfQuaternion unit_quaternion(const GltfQuaternion& q);

}  // namespace rlpc
