// The coarse meshes of a stream (8.9.8) in a page: their sizes, and pictures of some of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/coarse_mesh.h"
#include "decoder/report/html_page.h"

namespace rlpc {

// Numbers of layers, ascending: up to four coarse meshes, the last with as many triangles as
// are allowed, each with about four times those of the one before.
std::vector<std::uint32_t> layers_of_pictures(const CoarseMeshes& meshes,
                                              std::uint32_t max_triangles);

// xyz: all vertices of the frame in decoded order.
void add_coarse_section(HtmlPage& page, const CoarseMeshes& meshes, std::uint32_t frame,
                        std::span<const float> xyz);

}  // namespace rlpc
