// Mesh and attributes to draw: vertices with one value of each set, and normals of any frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"
#include "decoder/surface/attribute_values.h"
#include "decoder/surface/split_vertices.h"

namespace rlpc {

// Returns whether vertices can have values of a set: sets of triangles cannot, nor sets of
// corners without triangles.
bool is_drawable(const AttributeHeader& header, std::span<const Triangle> triangles);
// Returns the drawable sets.
Vector<const AttributeSet*> drawable_sets(const Vector<AttributeSet>& sets,
                                          std::span<const Triangle> triangles);
// Returns whether normals of any frame follow from a set: the set `normal`, of vertices or
// corners.
bool is_normal_set(const AttributeHeader& header);

class DrawnMesh {
 public:
  // sets: drawable sets, may be empty. Sets and triangles must outlive it. Time and memory: see
  // split_vertices().
  DrawnMesh(Vector<const AttributeSet*> sets, std::span<const Triangle> triangles,
            std::uint32_t num_vertices);

  const SplitVertices& vertices() const { return vertices_; }
  std::span<const AttributeSet* const> sets() const { return sets_; }
  // Returns the values of a set at the vertices: [vertex][number_components()].
  Vector<float> numbers(std::size_t set) const;
  bool has_normals() const { return normals_.has_value(); }
  FrameNormals& normals() { return *normals_; }
  // Returns the index in normals() of the normal of each vertex; empty without normals.
  std::span<const std::uint32_t> normal_of_vertex() const;

 private:
  Vector<const AttributeSet*> sets_;
  SplitVertices vertices_;
  std::size_t normal_set_ = 0;
  std::optional<FrameNormals> normals_;
};

}  // namespace rlpc
