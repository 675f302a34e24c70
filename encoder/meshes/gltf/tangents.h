// Compares tangents of a primitive with those that viewers compute without them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

struct TangentSource {
  std::span<const Triangle> triangles;
  std::span<const float> positions;  // 3 for each vertex
  std::span<const float> normals;    // 3
  std::span<const float> uv;         // 2, those of the normal map
  std::span<const float> tangents;   // 4, as in glTF
};

// Numbers of corners.
struct TangentCount {
  std::uint64_t corners = 0;   // compared ones: texture coordinates have an area
  std::uint64_t apart = 0;     // differ by more than kTangentsApart
  std::uint64_t inverted = 0;  // among these: by more than a right angle, or in handedness

  void add(const TangentCount& other);
};

inline constexpr int kTangentsApart = 15;  // degrees

// Compares tangents with those that MikkTSpace computes from positions, normals and texture
// coordinates: means of the triangles around a vertex with the same normal, coordinates and
// handedness, weighted by angle.
TangentCount compare_tangents(const TangentSource& source);

// Returns a note on what that means for relief; empty: tangents are those that viewers compute.
std::string tangent_note(const TangentCount& count);

}  // namespace rlpc
