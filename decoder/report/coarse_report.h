// Section of a page on the coarse meshes of a stream (8.9.8): sizes, and pictures of some.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/coarse_mesh.h"
#include "decoder/report/html_page.h"

namespace rlpc {

// Returns the numbers of layers of up to four coarse meshes, ascending: each has about four
// times the triangles of the previous one, and the last as many as are allowed.
std::vector<std::uint32_t> layers_of_pictures(const CoarseMeshes& meshes,
                                              std::uint32_t max_triangles);

// Adds the section. xyz: all vertices of the frame in decoded order.
void add_coarse_section(HtmlPage& page, const CoarseMeshes& meshes, std::uint32_t frame,
                        std::span<const float> xyz);

}  // namespace rlpc
