// Splits polygons into triangles that cover them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rlpc {

// The corners of a triangle, by their numbers in the polygon.
using PolygonTriangle = std::array<std::uint32_t, 3>;

// Splits a polygon, seen along its mean normal, into n - 2 triangles between its corners, each
// turning the same way. Returns none if the fan from the first corner, (0, 1, 2), (0, 2, 3) and
// so on, covers it, as it does for every convex polygon; or if nothing covers it better, as for
// outlines that cross themselves or have no area.
//
// corners: positions of the n corners, at least 3, all finite, in order. Corners may coincide,
//   lie on edges or on one line; holes may be joined to the outline by pairs of edges.
//
// The result is the same on every machine. Time: about n * log n for outlines as they occur,
// never more than some 10^8 comparisons.
//
// gave_up: set to true if that many comparisons were not enough, and triangles fold.
std::vector<PolygonTriangle> split_polygon(std::span<const std::array<double, 3>> corners,
                                           bool* gave_up = nullptr);

}  // namespace rlpc
