// Projection and hidden-surface removal for pictures of meshes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace rlpc {

// Size of a picture in pixels.
inline constexpr double kPictureWidth = 340;
inline constexpr double kPictureHeight = 300;

using Point = std::array<double, 3>;  // to the right, down, towards the viewer; in pixels

enum class ViewFrom : std::uint8_t { kFront, kBehind };

// Projects points to the first view of the mesh viewer (viewer/camera.js), or the opposite one,
// without perspective and as large as fits the picture.
std::vector<Point> projected(std::span<const float> xyz, ViewFrom from = ViewFrom::kFront);

// Returns the brightness of either side of a triangle: 0 (seen edge-on) to 9 (seen face-on).
int brightness(const Point& a, const Point& b, const Point& c);

// Formats a path, "M1.0 2.0L3.0 4.0L5.0 6.0Z".
std::string outline(std::span<const Point> points);

// Element of a picture, and its nearness to the viewer.
struct Shape {
  double nearness = 0;
  std::string svg;
};

// Joins the shapes from back to front; equally near shapes keep their order.
std::string drawn(std::vector<Shape> shapes);

}  // namespace rlpc
