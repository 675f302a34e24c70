#include "decoder/report/coarse_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace rlpc {
namespace {

using Point = std::array<double, 3>;  // to the right, up, towards the viewer

constexpr std::uint32_t kMaxTriangles = 6000;  // of a picture: about 70 bytes each
constexpr std::size_t kMaxPictures = 4;
constexpr double kWidth = 340;
constexpr double kHeight = 300;
constexpr double kMargin = 8;

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// In the first view of the mesh viewer (viewer/camera.js), without perspective.
std::vector<Point> first_view(std::span<const float> xyz) {
  constexpr double kYaw = 0.5;
  constexpr double kPitch = 0.3;
  const Point right{std::cos(kYaw), 0, -std::sin(kYaw)};
  const Point up{-std::sin(kPitch) * std::sin(kYaw), std::cos(kPitch),
                 -std::sin(kPitch) * std::cos(kYaw)};
  const Point towards{std::cos(kPitch) * std::sin(kYaw), std::sin(kPitch),
                      std::cos(kPitch) * std::cos(kYaw)};
  std::vector<Point> points(xyz.size() / 3);
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Point p{xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]};
    points[v] = {dot(right, p), dot(up, p), dot(towards, p)};
  }
  return points;
}

// As large as fits the picture; y downwards.
void fit(std::vector<Point>& points) {
  constexpr double kFar = std::numeric_limits<double>::max();
  Point low{kFar, kFar, kFar};
  Point high{-kFar, -kFar, -kFar};
  for (const Point& p : points) {
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], p[c]);
      high[c] = std::max(high[c], p[c]);
    }
  }
  const double span = std::max({(high[0] - low[0]) / (kWidth - 2 * kMargin),
                                (high[1] - low[1]) / (kHeight - 2 * kMargin), 1e-30});
  for (Point& p : points) {
    p[0] = kWidth / 2 + (p[0] - (low[0] + high[0]) / 2) / span;
    p[1] = kHeight / 2 - (p[1] - (low[1] + high[1]) / 2) / span;
    p[2] /= span;
  }
}

// Of 0 (seen from the side) to 9 (from the front), whichever side is seen.
int brightness(const Point& a, const Point& b, const Point& c) {
  const Point u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Point w{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const Point normal{u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                     u[0] * w[1] - u[1] * w[0]};
  const double length = std::sqrt(dot(normal, normal));
  return length > 0 ? static_cast<int>(9 * std::abs(normal[2]) / length) : 0;
}

// Triangles with their edges, from back to front.
std::string picture(const CoarseMesh& mesh, const std::vector<Point>& points) {
  const auto corner = [&](std::uint32_t i) -> const Point& { return points[mesh.vertices[i]]; };
  std::vector<double> depth(mesh.triangles.size());
  for (std::size_t t = 0; t < depth.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) depth[t] += corner(v)[2];
  }
  std::vector<std::size_t> order(depth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return depth[a] < depth[b]; });
  std::string svg;
  for (const std::size_t t : order) {
    const auto& [a, b, c] = mesh.triangles[t];
    svg += "<path class=\"m" + std::to_string(brightness(corner(a), corner(b), corner(c))) +
           "\" d=\"M";
    for (const std::uint32_t v : {a, b, c}) {
      svg += number_text(corner(v)[0]) + " " + number_text(corner(v)[1]) + " ";
    }
    svg.back() = 'Z';
    svg += "\"/>\n";
  }
  return svg;
}

std::string size_text(std::uint32_t layers, const MeshSize& size) {
  return std::to_string(layers) + (layers == 1 ? " layer: " : " layers: ") +
         grouped_text(size.num_vertices) + " vertices, " + grouped_text(size.num_triangles) +
         " triangles";
}

std::string pictures(const CoarseMeshes& meshes, std::span<const float> xyz) {
  std::vector<Point> points = first_view(xyz);
  fit(points);
  std::string html;
  for (const std::uint32_t layers : layers_of_pictures(meshes, kMaxTriangles)) {
    html += "<figure class=\"card\"><svg class=\"mesh\" viewBox=\"0 0 " + number_text(kWidth) +
            " " + number_text(kHeight) + "\" role=\"img\">\n" +
            picture(meshes.mesh(layers), points) + "</svg><figcaption>" +
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
  std::vector<double> sizes;  // of the meshes with 1, 2, ... layers
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

void add_coarse_section(HtmlPage& page, const CoarseMeshes& meshes,
                        std::span<const float> xyz) {
  page.add_section(
      "Coarse meshes",
      "What remains of the mesh without its higher vertex layers (rlpcdec --coarse); the first "
      "frame.",
      pictures(meshes, xyz) + size_table(meshes));
}

}  // namespace rlpc
