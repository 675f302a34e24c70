// Distances along the surface of a mesh that are longer across creases (Katz and Tal 2003; Liu
// and Zhang 2004), and samples that cover it evenly.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/partition/graph.h"
#include "encoder/codec/partition/point_tree.h"

namespace rlpc {

// Returns the lengths of the edges of a graph: the geodesic and the angular distance of their
// ends, each relative to its mean. The papers use faces that share an edge; here, vertices and
// their normals take their place. Normals that turn towards each other, in a concave place,
// count most. Points without triangles have no normals, and geodesic distances alone.
//
//   returns  [graph.neighbour.size()]
std::vector<double> surface_lengths(const Graph& graph, std::span<const Point3> points,
                                    std::span<const Triangle> triangles);

struct SurfaceSamples {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> nearest;  // [num_vertices], nearest sample
  std::vector<double> distance;        // [count][count], shortest paths between samples
};

// Takes up to `count` samples, each farthest from those before it. Paths between samples lead
// through their cells, the vertices that they are nearest to.
//
//   graph    connected
//   lengths  lengths of its edges, not negative
SurfaceSamples sample_surface(const Graph& graph, std::span<const double> lengths,
                              std::uint32_t count);

}  // namespace rlpc
