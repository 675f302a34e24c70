// Vertices for formats in which a vertex has one value of each attribute, as in glTF and PLY:
// vertices of the stream are split by the distinct combinations of values at their corners.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

// Vertices of the output.
struct SplitVertices {
  Vector<std::uint32_t> stream_vertex;  // [v], ascending
  // [set][v]: index of a value of the set, or of a normal of FrameNormals.
  Vector<Vector<std::uint32_t>> value_of_vertex;
  // Triangles of output vertices, in the order of the stream.
  Vector<Triangle> triangles;

  std::uint32_t num_vertices() const {
    return static_cast<std::uint32_t>(stream_vertex.size());
  }
};

// Splits the vertices. sets: of vertices, or of corners if there are triangles; may be empty.
// Compares values or, in sets with faces, whose normals differ from frame to frame, indices.
// Vertices without triangles stay, with their own value or the first one. For n corners, each
// set takes time proportional to n log n, and memory proportional to n.
SplitVertices split_vertices(std::span<const Triangle> triangles, std::uint32_t num_vertices,
                             std::span<const AttributeSet* const> sets);

}  // namespace rlpc
