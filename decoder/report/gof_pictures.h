// Pictures of a frame: the clusters, bones or patches that code it, and its vertex layers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/mesh/coarse_mesh.h"
#include "decoder/report/html_page.h"
#include "decoder/report/vertex_groups.h"

namespace rlpc {

// Maximum number of triangles in each of the two views of a picture; a larger mesh is shown as
// a coarse mesh. A triangle takes up to 280 bytes.
inline constexpr std::uint32_t kMaxFileTriangles = 10000;  // picture in a separate file
inline constexpr std::uint32_t kMaxPageTriangles = 2000;   // smaller picture in a page

struct PicturedFrame {
  std::uint32_t frame = 0;
  std::vector<float> xyz;                // all vertices in decoded order; grid units
  VertexGroups groups;                   // groups of its GOF
  const CoarseMeshes* meshes = nullptr;  // not owned
};

struct GofPicture {
  std::string name;   // "clusters", "bones", "patches" or "layers"
  std::string title;  // one line, like each of the notes
  std::vector<std::string> notes;
  std::string body;  // elements of an SVG
  double width = 0;
  double height = 0;
};

// Draws clusters, bones or patches, if the GOF has them, then the layers.
std::vector<GofPicture> gof_pictures(const PicturedFrame& frame, std::uint32_t max_triangles);

// Returns a whole SVG file, for light and dark backgrounds.
std::string svg_file(const GofPicture& picture);

void add_picture_section(HtmlPage& page, const PicturedFrame& frame);

}  // namespace rlpc
