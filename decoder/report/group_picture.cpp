#include "decoder/report/group_picture.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "decoder/report/svg_axis.h"

namespace rlpc {
namespace {

constexpr double kBrightest = 9;   // maximum of brightness()
constexpr double kSeedAhead = 12;  // pixels: larger than most triangles

Point middle_of(const Point& a, const Point& b) {
  return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

std::string path(const std::string& class_name, const std::string& attributes,
                 const std::string& d) {
  return "<path class=\"" + class_name + "\" " + attributes + " d=\"" + d + "\"/>\n";
}

class Drawing {
 public:
  Drawing(std::span<const Point> points, const ColouredVertices& vertices)
      : points_(points), vertices_(vertices) {}

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const std::array<Point, 3> corners{points_[a], points_[b], points_[c]};
    const double shade = brightness(corners[0], corners[1], corners[2]) / kBrightest;
    const double nearness = corners[0][2] + corners[1][2] + corners[2][2];
    const auto& group = vertices_.group;
    if (group[a] == group[b] && group[b] == group[c]) {
      shapes_.push_back({nearness, piece(a, shade, outline(corners))});
      return;
    }
    const Point centre{(corners[0][0] + corners[1][0] + corners[2][0]) / 3,
                       (corners[0][1] + corners[1][1] + corners[2][1]) / 3, nearness / 3};
    const std::array<std::uint32_t, 3> corner_vertices{a, b, c};
    std::string cells;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::array<Point, 4> cell{corners[k], middle_of(corners[k], corners[(k + 1) % 3]),
                                      centre, middle_of(corners[k], corners[(k + 2) % 3])};
      cells += piece(corner_vertices[k], shade, outline(cell));
    }
    shapes_.push_back({nearness, std::move(cells)});
  }

  void add_dot(std::uint32_t v) {
    const Point& p = points_[v];
    shapes_.push_back(
        {3 * p[2], piece(v, 1, "M" + pixel_text(p[0]) + " " + pixel_text(p[1]) + "h0")});
  }

  // Adds a seed triangle. Its corners may be far apart, with the surface between: it is drawn
  // in front of the surroundings of the nearest corner.
  void add_seed(const std::array<std::uint32_t, 3>& seed) {
    const std::array<Point, 3> corners{points_[seed[0]], points_[seed[1]], points_[seed[2]]};
    const double nearest = std::max({corners[0][2], corners[1][2], corners[2][2]});
    const std::string d = outline(corners);
    shapes_.push_back(
        {3 * (nearest + kSeedAhead),
         path("seed", "fill=\"none\" stroke=\"#fff\" stroke-width=\"2.6\"", d) +
             path("seed", "fill=\"none\" stroke=\"#000\" stroke-width=\"1\"", d)});
  }

  std::string svg() && { return drawn(std::move(shapes_)); }

 private:
  std::string piece(std::uint32_t v, double shade, const std::string& d) const {
    const std::uint32_t group = vertices_.group[v];
    return path("g" + std::to_string(group),
                "color=\"" + colour_text(vertices_.colours[group], shade) + "\"", d);
  }

  std::span<const Point> points_;
  const ColouredVertices& vertices_;
  std::vector<Shape> shapes_;
};

}  // namespace

std::string group_picture(const CoarseMesh& mesh, std::span<const Point> points,
                          const ColouredVertices& vertices, double x, double y) {
  const bool as_dots = mesh.triangles.empty();
  Drawing drawing(points, vertices);
  for (const auto& [a, b, c] : mesh.triangles)
    drawing.add_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  if (as_dots) {
    for (const std::uint32_t v : mesh.vertices) drawing.add_dot(v);
  }
  for (const auto& seed : vertices.seeds) drawing.add_seed(seed);
  // The stroke closes gaps between neighbours due to smoothing.
  return "<g class=\"view\" transform=\"translate(" + pixel_text(x) + " " + pixel_text(y) +
         ")\" fill=\"currentColor\" stroke=\"currentColor\" stroke-width=\"" +
         (as_dots ? "3\" stroke-linecap" : "0.5\" stroke-linejoin") + "=\"round\">\n" +
         std::move(drawing).svg() + "</g>\n";
}

}  // namespace rlpc
