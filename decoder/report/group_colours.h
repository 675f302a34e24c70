// Colours of the parts of a mesh in pictures.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Colour in the space OKLab, where distances are about perceived differences: lightness, green
// to red, blue to yellow.
using Colour = std::array<double, 3>;

double colour_distance(const Colour& a, const Colour& b);

// Returns colours of groups without an order. Up to 36 groups have different colours; with
// more, colours recur, but not in groups that an edge of a triangle connects, unless a group
// has 36 such neighbours.
//   group_of_vertex  [num_vertices], below num_groups
//   triangles        indices into group_of_vertex
std::vector<Colour> group_colours(std::uint32_t num_groups,
                                  std::span<const std::uint32_t> group_of_vertex,
                                  std::span<const Triangle> triangles);

// Returns colours of groups in an order, from dark violet to light yellow.
std::vector<Colour> ramp_colours(std::uint32_t num_groups);

// Formats "#rrggbb". shade: 0, darkest, to 1, the colour itself.
std::string colour_text(const Colour& colour, double shade = 1);

}  // namespace rlpc
