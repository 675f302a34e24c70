// The codecs that scripts/compare compares with ours. Each encodes an animation to one file of
// its own form, and decodes it. These files are not part of the project's formats.
//
// Failures are exceptions (std::runtime_error), as only the program that has just written such
// a file reads it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc::peers {

struct Animation {
  std::uint32_t num_vertices = 0;
  std::vector<Triangle> triangles;
  std::vector<std::vector<float>> frames;  // xyz[3 * vertex + axis]
};

// Positions as origin[axis] + step * q; frames[f][3 * vertex + axis] below 2^bits, bits <= 16.
struct QuantisedAnimation {
  std::uint32_t num_vertices = 0;
  std::vector<Triangle> triangles;
  float origin[3] = {};
  float step = 1.0F;
  std::vector<std::vector<std::uint16_t>> frames;
};

// The longest side of the bounding box of all frames.
double longest_side(const Animation& animation);

// One grid for all frames: 2^bits - 1 steps over the longest side of their bounding box.
QuantisedAnimation quantise(const Animation& animation, int bits);
Animation dequantise(const QuantisedAnimation& quantised);

using Bytes = std::string;

// Changes in time, predicted from those of neighbours on the mesh (a Lorenzo predictor), as
// 16-bit numbers for a general-purpose compressor.
Bytes write_lorenzo(const QuantisedAnimation& animation);
QuantisedAnimation read_lorenzo(const Bytes& bytes);

// Differences from the previous frame by the vertex codec of meshoptimizer, triangles by its
// index codec; for a general-purpose compressor.
Bytes write_meshopt(const QuantisedAnimation& animation);
QuantisedAnimation read_meshopt(const Bytes& bytes);

// zfp with an error bound of 2^-bits of the longest side of the bounding box; each axis as
// an array of frames and vertices.
Bytes write_zfp(const Animation& animation, int bits);
Animation read_zfp(const Bytes& bytes);

// A draco mesh for every frame, with the slowest setting: by Edgebreaker, or in sequence if the
// mesh is one that Edgebreaker changes. draco reorders the vertices and repeats those where
// fans meet: order[decoded vertex] is the index in `animation`.
Bytes write_draco(const Animation& animation, int bits);
Animation read_draco(const Bytes& bytes);
std::vector<std::uint32_t> draco_order(const Animation& animation);

}  // namespace rlpc::peers
