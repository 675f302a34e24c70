// Graph of a mesh, for its partitions.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/partition/graph.h"
#include "encoder/codec/partition/point_tree.h"

namespace rlpc {

inline constexpr std::uint32_t kMeshEdge = 4;  // fixed: so that links are cut first
inline constexpr std::uint32_t kLink = 1;      // fixed: the least

// Makes a vertex of weight 1 for each vertex of the mesh, and an edge of weight kMeshEdge for
// each edge. Components of the mesh, such as the single points of a point cloud, are linked to
// the nearest other ones by edges of small weight, until all vertices are connected.
Graph make_mesh_graph(std::span<const Point3> points, std::span<const Triangle> triangles);

}  // namespace rlpc
