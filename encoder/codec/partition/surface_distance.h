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

// The lengths of the edges of a graph: the geodesic and the angular distance of their ends,
// each relative to its mean. The papers take faces that share an edge; here, vertices and their
// normals stand for them. Normals that turn towards each other, in a concave place, count most.
// Points without triangles have no normals, and geodesic distances alone.
//
//   returns  [graph.neighbour.size()]
std::vector<double> surface_lengths(const Graph& graph, std::span<const Point3> points,
                                    std::span<const Triangle> triangles);

struct SurfaceSamples {
  std::uint32_t count = 0;
  std::vector<std::uint32_t> nearest;  // [num_vertices], sample that is nearest to the vertex
  std::vector<double> distance;        // [count][count], shortest ways between samples
};

// Up to `count` samples, each farthest from those before it. Ways between them lead through the
// cells of vertices that they are nearest to.
//
//   graph    connected
//   lengths  of its edges, not negative
SurfaceSamples sample_surface(const Graph& graph, std::span<const double> lengths,
                              std::uint32_t count);

}  // namespace rlpc
