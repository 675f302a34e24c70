// 8.18.1 and 8.18.2: coding order of rest positions in the High profile, and the vertices from
// which each is predicted. Both follow from connectivity alone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/topology.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::size_t kMaxRestHinges = 4;  // per vertex
inline constexpr std::size_t kMaxRestRing = 2 * kMaxRestHinges;

// Two triangles that share an edge, seen from vertex v: (v, a, b) in its orientation, and the
// triangle of a, b and c.
struct Hinge {
  std::uint32_t a;
  std::uint32_t b;
  std::uint32_t c;
};

// Vertex v of a hinge. mirrored: whether its triangle is (v, b, a).
struct VertexOfHinge {
  std::uint32_t vertex;
  bool mirrored;
};

class RestOrder {
 public:
  // Topology and triangles are read only during the call.
  RestOrder(const Topology& topology, std::span<const Triangle> triangles);

  std::uint32_t num_vertices() const { return static_cast<std::uint32_t>(place_.size()); }
  std::span<const std::uint32_t> order() const { return order_; }
  std::uint32_t place(std::uint32_t v) const { return place_[v]; }
  // RestHinges: at most kMaxRestHinges hinges of vertices that precede v in the order.
  std::span<const Hinge> hinges(std::uint32_t v) const { return hinges_of_vertex_[v]; }
  // RestRing: at most kMaxRestRing vertices that precede v in the order.
  std::span<const std::uint32_t> ring(std::uint32_t v) const { return rings_[v]; }
  // 8.18.4 VertexAcross( a, b, c )
  std::optional<VertexOfHinge> across(const Hinge& hinge) const;

 private:
  // Two triangles across the edge (low, high).
  struct Edge {
    std::uint32_t low;
    std::uint32_t high;
    std::array<std::uint32_t, 2> corners;
    std::array<bool, 2> backward;  // whether the triangle is (corner, high, low)

    Hinge seen_from(std::size_t k) const {
      return backward[k] ? Hinge{high, low, corners[1 - k]} : Hinge{low, high, corners[1 - k]};
    }
  };

  void find_edges(std::span<const Triangle> triangles);
  void make_order();
  void make_rings(const Topology& topology);

  Vector<std::uint32_t> order_;
  Vector<std::uint32_t> place_;  // [num_vertices]
  ListOfLists<Hinge> hinges_of_vertex_;
  ListOfLists<std::uint32_t> rings_;
  Vector<Edge> edges_;                // Hinges, sorted by their lower vertex
  Vector<std::uint32_t> first_edge_;  // [num_vertices + 1] first edge of a lower vertex
  Vector<std::uint32_t> by_ends_;     // indices into edges_, sorted by both ends
};

}  // namespace rlpc
