// Vertices for formats in which a vertex has one value of each attribute, as in glTF and PLY:
// vertices of the stream are split by the distinct combinations of values at their corners.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

// What is written of a vertex v of the output.
struct SplitVertices {
  Vector<std::uint32_t> stream_vertex;  // [v], ascending
  // [set][v]: index of a value of the set, or of a normal of FrameNormals.
  Vector<Vector<std::uint32_t>> value_of_vertex;
  // Of the output; the same order and corners as in the stream.
  Vector<Triangle> triangles;

  std::uint32_t num_vertices() const {
    return static_cast<std::uint32_t>(stream_vertex.size());
  }
};

// sets: of vertices, or of corners if there are triangles; may be empty. Values count as the
// same if they are equal, except those of sets with faces: their normals differ from frame to
// frame, so that their indices count. Vertices without triangles stay, with the value of their
// own or the first one. Time: in proportion to n log n, memory to n, the number of corners, for
// each set.
SplitVertices split_vertices(std::span<const Triangle> triangles, std::uint32_t num_vertices,
                             std::span<const AttributeSet* const> sets);

}  // namespace rlpc
