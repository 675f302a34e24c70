// Tangents of a primitive beside those that viewers compute without them.
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
  std::span<const float> uv;         // 2, of the normal map
  std::span<const float> tangents;   // 4, as in glTF
};

// Numbers of corners.
struct TangentCount {
  std::uint64_t corners = 0;   // compared: texture coordinates have an area
  std::uint64_t apart = 0;     // others by more than kTangentsApart
  std::uint64_t inverted = 0;  // of these: by more than a right angle, or of the other hand

  void add(const TangentCount& other);
};

inline constexpr int kTangentsApart = 15;  // degrees

// Compares tangents with those that follow from positions, normals and texture coordinates as
// MikkTSpace has them: means of the triangles around a vertex of the same normal, coordinates
// and hand, weighted by angle.
TangentCount compare_tangents(const TangentSource& source);

// What that means for relief; empty: tangents are those that viewers compute.
std::string tangent_note(const TangentCount& count);

}  // namespace rlpc
