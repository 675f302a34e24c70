#include "decoder/report/mesh_projection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "decoder/report/svg_axis.h"

namespace rlpc {
namespace {

constexpr double kMargin = 8;

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Turns points to the axes right, up, towards the viewer.
std::vector<Point> turned(std::span<const float> xyz, double yaw) {
  constexpr double kPitch = 0.3;
  const Point right{std::cos(yaw), 0, -std::sin(yaw)};
  const Point up{-std::sin(kPitch) * std::sin(yaw), std::cos(kPitch),
                 -std::sin(kPitch) * std::cos(yaw)};
  const Point towards{std::cos(kPitch) * std::sin(yaw), std::sin(kPitch),
                      std::cos(kPitch) * std::cos(yaw)};
  std::vector<Point> points(xyz.size() / 3);
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Point p{xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]};
    points[v] = {dot(right, p), dot(up, p), dot(towards, p)};
  }
  return points;
}

// Scales points to the size of the picture; y points down.
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
  const double span = std::max({(high[0] - low[0]) / (kPictureWidth - 2 * kMargin),
                                (high[1] - low[1]) / (kPictureHeight - 2 * kMargin), 1e-30});
  for (Point& p : points) {
    p[0] = kPictureWidth / 2 + (p[0] - (low[0] + high[0]) / 2) / span;
    p[1] = kPictureHeight / 2 - (p[1] - (low[1] + high[1]) / 2) / span;
    p[2] /= span;
  }
}

}  // namespace

std::vector<Point> projected(std::span<const float> xyz, ViewFrom from) {
  constexpr double kYaw = 0.5;
  constexpr double kHalfTurn = 3.14159265358979323846;
  std::vector<Point> points = turned(xyz, from == ViewFrom::kFront ? kYaw : kYaw + kHalfTurn);
  fit(points);
  return points;
}

int brightness(const Point& a, const Point& b, const Point& c) {
  const Point u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Point w{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const Point normal{u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                     u[0] * w[1] - u[1] * w[0]};
  const double length = std::sqrt(dot(normal, normal));
  return length > 0 ? static_cast<int>(9 * std::abs(normal[2]) / length) : 0;
}

std::string outline(std::span<const Point> points) {
  std::string path;
  for (const Point& p : points) {
    path += (path.empty() ? "M" : "L") + pixel_text(p[0]) + " " + pixel_text(p[1]);
  }
  return path + "Z";
}

std::string drawn(std::vector<Shape> shapes) {
  std::stable_sort(shapes.begin(), shapes.end(),
                   [](const Shape& a, const Shape& b) { return a.nearness < b.nearness; });
  std::string svg;
  for (const Shape& shape : shapes) svg += shape.svg;
  return svg;
}

}  // namespace rlpc
