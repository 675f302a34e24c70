#include "decoder/report/coarse_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "decoder/report/mesh_projection.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kMaxTriangles = 6000;  // per picture, about 60 bytes each
constexpr std::size_t kMaxPictures = 4;

// Draws triangles with their edges.
std::string picture(const CoarseMesh& mesh, const std::vector<Point>& points) {
  std::vector<Shape> shapes;
  for (const auto& [i, j, k] : mesh.triangles) {
    const std::array<Point, 3> corners{points[mesh.vertices[i]], points[mesh.vertices[j]],
                                       points[mesh.vertices[k]]};
    const auto& [a, b, c] = corners;
    shapes.push_back({a[2] + b[2] + c[2], "<path class=\"m" +
                                              std::to_string(brightness(a, b, c)) + "\" d=\"" +
                                              outline(corners) + "\"/>\n"});
  }
  return drawn(std::move(shapes));
}

std::string size_text(std::uint32_t layers, const MeshSize& size) {
  return std::to_string(layers) + (layers == 1 ? " layer: " : " layers: ") +
         grouped_text(size.num_vertices) + " vertices, " + grouped_text(size.num_triangles) +
         " triangles";
}

std::string pictures(const CoarseMeshes& meshes, std::span<const float> xyz) {
  const std::vector<Point> points = projected(xyz);
  std::string html;
  for (const std::uint32_t layers : layers_of_pictures(meshes, kMaxTriangles)) {
    html += "<figure class=\"card\"><svg class=\"mesh\" viewBox=\"0 0 " +
            number_text(kPictureWidth) + " " + number_text(kPictureHeight) +
            "\" role=\"img\">\n" + picture(meshes.mesh(layers), points) + "</svg><figcaption>" +
            size_text(layers, meshes.size(layers)) + "</figcaption></figure>\n";
  }
  return html.empty() ? "" : "<div class=\"pictures\">\n" + html + "</div>\n";
}

std::string size_table(const CoarseMeshes& meshes) {
  std::string html =
      "<details class=\"card wide\"><summary>All coarse meshes</summary><table>\n"
      "<thead><tr><th>layers</th><th>vertices</th><th>triangles</th></tr></thead>\n";
  for (std::uint32_t layers = 1; layers <= meshes.num_layers(); ++layers) {
    const MeshSize size = meshes.size(layers);
    html += "<tr><td>" + std::to_string(layers) + "</td><td>" +
            grouped_text(size.num_vertices) + "</td><td>" + grouped_text(size.num_triangles) +
            "</td></tr>\n";
  }
  return html + "</table></details>\n";
}

}  // namespace

std::vector<std::uint32_t> layers_of_pictures(const CoarseMeshes& meshes,
                                              std::uint32_t max_triangles) {
  std::vector<double> sizes;  // sizes of the meshes with 1, 2, ... layers
  for (std::uint32_t layers = 1; layers <= meshes.num_layers(); ++layers) {
    const std::uint32_t size = meshes.size(layers).num_triangles;
    if (size > max_triangles) break;
    sizes.push_back(size);
  }
  std::vector<std::uint32_t> chosen;
  if (sizes.empty() || sizes.back() == 0) return chosen;
  for (std::size_t i = kMaxPictures; i-- > 0;) {
    const double wanted = sizes.back() / std::pow(4, i);
    const auto nearest = std::min_element(sizes.begin(), sizes.end(), [&](double a, double b) {
      return std::abs(a - wanted) < std::abs(b - wanted);
    });
    const auto layers = static_cast<std::uint32_t>(nearest - sizes.begin()) + 1;
    if (chosen.empty() || layers > chosen.back()) chosen.push_back(layers);
  }
  return chosen;
}

void add_coarse_section(HtmlPage& page, const CoarseMeshes& meshes, std::uint32_t frame,
                        std::span<const float> xyz) {
  page.add_section(
      "Coarse meshes",
      "What remains of the mesh without its higher vertex layers (rlpcdec --coarse); frame " +
          std::to_string(frame) + ".",
      pictures(meshes, xyz) + size_table(meshes));
}

}  // namespace rlpc
