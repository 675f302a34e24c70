// Orders the vertices from coarse to fine, from connectivity alone (clause 8.9).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::size_t kMaxRing = 7;        // vertices in a ring
inline constexpr std::size_t kMaxOuterRing = 24;  // vertices in an outer ring
inline constexpr std::uint32_t kMaxLayers = 212;  // for up to 2^23 vertices

// Short list per vertex, in one flat array, in the order in which lists are set.
class VertexLists {
 public:
  VertexLists() = default;
  explicit VertexLists(std::uint32_t num_vertices)
      : first_(num_vertices), size_(num_vertices) {}
  std::span<const std::uint32_t> operator[](std::size_t v) const {
    return std::span<const std::uint32_t>(items_).subspan(first_[v], size_[v]);
  }
  std::size_t size() const { return first_.size(); }
  // Sets a list of at most 255 items, at most once per vertex. Unset lists are empty.
  void set(std::uint32_t v, std::span<const std::uint32_t> items);

 private:
  Vector<std::uint32_t> first_;  // [size]
  Vector<std::uint8_t> size_;    // [size]
  Vector<std::uint32_t> items_;
};

struct VertexLayers {
  std::uint32_t num_layers = 1;
  Vector<std::uint8_t> layer_of_vertex;  // [num_vertices]; 0 is the base, the coarsest layer
  Vector<std::uint32_t> layer_order;     // all vertices, by layer, then by index
  VertexLists ring;                      // in the order of the walk; in the base: ascending
  VertexLists outer_ring;                // ascending; in the base: empty
};

// Triangle of the remaining mesh while that has min_layers to max_layers layers.
struct LayeredTriangle {
  Triangle vertices{};
  std::uint8_t min_layers = 1;
  std::uint8_t max_layers = 1;
};
// RestTriangles of 8.9.2. A removal adds at most five triangles per triangle by which it
// reduces the remaining mesh, so that a mesh of n triangles has at most 6 * n; closed surfaces
// have at most 3 * n.
using LayeredTriangles = Vector<LayeredTriangle>;

// 8.9 Vertex layers
//
//   num_vertices  at most 2^23
//   triangles     at most 2^24, any mesh; indices < num_vertices
//   all           unless null, receives RestTriangles, in that order
//
// The vertices of ring[v] and outer_ring[v] precede v in layer_order, and are in lower layers
// unless v is in the base. Time and memory are linear in vertices and triangles.
VertexLayers make_layers(std::uint32_t num_vertices, std::span<const Triangle> triangles,
                         LayeredTriangles* all = nullptr);

}  // namespace rlpc
