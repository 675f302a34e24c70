// The animation of one property of one node: keys and their interpolation.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "encoder/meshes/gltf/document/affine.h"
#include "encoder/meshes/gltf/document/document.h"

namespace rlpc {

struct GltfTrack {
  GltfInterpolation interpolation = GltfInterpolation::kLinear;
  std::size_t width = 0;      // numbers per value
  std::vector<float> times;   // seconds, ascending, at least one
  std::vector<float> values;  // `width` per time; cubic: in-tangent, value, out-tangent
};

// Evaluates a track. Before the first key and after the last, the value is held. out: [width].
void sample(const GltfTrack& track, double time, std::span<double> out);

// Evaluates a track of unit quaternions: linear interpolation is spherical, along the shorter
// arc.
GltfQuaternion sample_rotation(const GltfTrack& track, double time);

// Normalises a quaternion; zero becomes the identity.
GltfQuaternion unit_quaternion(const GltfQuaternion& q);

}  // namespace rlpc
