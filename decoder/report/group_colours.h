// Colours of the parts of a mesh in pictures.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// In the colour space OKLab, where distances are about those that people see: lightness, then
// green to red, then blue to yellow.
using Colour = std::array<double, 3>;

double colour_distance(const Colour& a, const Colour& b);

// Groups without an order. Up to 36 have different colours; if there are more, colours recur,
// but not in groups that an edge of a triangle connects, unless one has 36 such neighbours.
//   group_of_vertex  [num_vertices], below num_groups
//   triangles        indices into group_of_vertex
std::vector<Colour> group_colours(std::uint32_t num_groups,
                                  std::span<const std::uint32_t> group_of_vertex,
                                  std::span<const Triangle> triangles);

// Groups in an order: from violet, dark, to yellow, light.
std::vector<Colour> ramp_colours(std::uint32_t num_groups);

// "#rrggbb". shade: of 0, darkest, to 1, the colour itself.
std::string colour_text(const Colour& colour, double shade = 1);

}  // namespace rlpc
