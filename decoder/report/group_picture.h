// Draws a mesh as SVG with each vertex in the colour of its group.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/codec/mesh/coarse_mesh.h"
#include "decoder/report/group_colours.h"
#include "decoder/report/mesh_projection.h"

namespace rlpc {

// Groups of all vertices of the mesh, of which only some may be drawn.
struct ColouredVertices {
  std::span<const std::uint32_t> group;                 // [num_vertices]
  std::span<const Colour> colours;                      // [num_groups]
  std::span<const std::array<std::uint32_t, 3>> seeds;  // triangles to outline
};

// Returns a `g` element of the size of a picture at (x, y). A triangle whose corners are in one
// group is one path; in any other, each corner has a path from the vertex to the middles of
// edges and triangle. Paths of group 7 have the class g7; outlines of seed triangles have the
// class seed. Without triangles, vertices are dots.
std::string group_picture(const CoarseMesh& mesh, std::span<const Point> points,
                          const ColouredVertices& vertices, double x, double y);

}  // namespace rlpc
