// Pictures of a frame: the clusters, bones or patches that code it, and the vertex layers of
// the mesh.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/mesh/coarse_mesh.h"
#include "decoder/report/html_page.h"
#include "decoder/report/vertex_groups.h"

namespace rlpc {

// The most triangles in one view of a picture; a larger mesh is shown as a coarse mesh. A
// triangle takes up to 280 bytes, and there are two views.
inline constexpr std::uint32_t kMaxFileTriangles = 10000;  // of a file of its own
inline constexpr std::uint32_t kMaxPageTriangles = 2000;   // of a page, where they are smaller

struct PicturedFrame {
  std::uint32_t frame = 0;
  std::vector<float> xyz;                // all vertices in decoded order; grid units
  VertexGroups groups;                   // of its GOF
  const CoarseMeshes* meshes = nullptr;  // not owned
};

struct GofPicture {
  std::string name;   // "clusters", "bones", "patches" or "layers"
  std::string title;  // of one line, as are the notes
  std::vector<std::string> notes;
  std::string body;  // elements of an SVG
  double width = 0;
  double height = 0;
};

// Clusters, bones or patches, if the GOF has them, then the layers.
std::vector<GofPicture> gof_pictures(const PicturedFrame& frame, std::uint32_t max_triangles);

// A whole SVG file, for light and dark backgrounds.
std::string svg_file(const GofPicture& picture);

void add_picture_section(HtmlPage& page, const PicturedFrame& frame);

}  // namespace rlpc
