// A mesh and its attributes as programs draw them: vertices with one value of each set, and
// normals of any frame.
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

// Whether vertices can have values of it: not those of triangles, nor of corners if there are
// no triangles.
bool is_drawable(const AttributeHeader& header, std::span<const Triangle> triangles);
// Those sets.
Vector<const AttributeSet*> drawable_sets(const Vector<AttributeSet>& sets,
                                          std::span<const Triangle> triangles);
// Whether normals of any frame follow from it: the set `normal`, of vertices or corners.
bool is_normal_set(const AttributeHeader& header);

class DrawnMesh {
 public:
  // sets: drawable ones; may be empty. They and the triangles must outlive it.
  // Time and memory: of split_vertices().
  DrawnMesh(Vector<const AttributeSet*> sets, std::span<const Triangle> triangles,
            std::uint32_t num_vertices);

  const SplitVertices& vertices() const { return vertices_; }
  std::span<const AttributeSet* const> sets() const { return sets_; }
  // The values of a set at the vertices: [vertex][number_components()].
  Vector<float> numbers(std::size_t set) const;
  // Whether there is a set of normals.
  bool has_normals() const { return normals_.has_value(); }
  FrameNormals& normals() { return *normals_; }
  // Index of the normal of each vertex, among those of normals(). Empty without.
  std::span<const std::uint32_t> normal_of_vertex() const;

 private:
  Vector<const AttributeSet*> sets_;
  SplitVertices vertices_;
  std::size_t normal_set_ = 0;
  std::optional<FrameNormals> normals_;
};

}  // namespace rlpc
