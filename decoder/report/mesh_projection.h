// What the pictures of meshes have in common: where points are, and what hides what.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace rlpc {

// Of a picture, in pixels.
inline constexpr double kPictureWidth = 340;
inline constexpr double kPictureHeight = 300;

using Point = std::array<double, 3>;  // to the right, down, towards the viewer; in pixels

enum class ViewFrom : std::uint8_t { kFront, kBehind };

// All points in the first view of the mesh viewer (viewer/camera.js) without perspective, as
// large as fits the picture, or in the opposite view.
std::vector<Point> projected(std::span<const float> xyz, ViewFrom from = ViewFrom::kFront);

// Of a triangle: 0 (seen from the side) to 9 (from the front), whichever side is seen.
int brightness(const Point& a, const Point& b, const Point& c);

// "M1.0 2.0L3.0 4.0L5.0 6.0Z"
std::string outline(std::span<const Point> points);

// An element of a picture, and how near it is to the viewer.
struct Shape {
  double nearness = 0;
  std::string svg;
};

// From back to front; equally near ones in their order.
std::string drawn(std::vector<Shape> shapes);

}  // namespace rlpc
