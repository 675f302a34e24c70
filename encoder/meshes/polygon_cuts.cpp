#include "encoder/meshes/polygon_cuts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "common/files/messages.h"
#include "encoder/meshes/mesh_reader.h"
#include "encoder/meshes/polygons/polygon.h"

namespace rlpc {

void PolygonCuts::add(const MeshPolygon& polygon, const std::vector<std::uint32_t>& corners) {
  cuts_.push_back({3 * polygon.first_triangle, places_.size(), corners.size()});
  for (const std::uint32_t corner : corners) {
    places_.push_back(static_cast<std::uint32_t>(place_in_fan(corner)));
  }
}

void PolygonCuts::apply(std::vector<std::uint32_t>& corners) const {
  if (corners.empty()) return;
  std::vector<std::uint32_t> fan;
  for (const Cut& cut : cuts_) {
    const auto first = corners.begin() + static_cast<std::ptrdiff_t>(cut.first_corner);
    fan.assign(first, first + static_cast<std::ptrdiff_t>(cut.count));
    for (std::size_t i = 0; i < cut.count; ++i) {
      corners[cut.first_corner + i] = fan[places_[cut.first_place + i]];
    }
  }
}

void PolygonCuts::apply(std::vector<Triangle>& triangles) const {
  std::vector<Triangle> fan;
  for (const Cut& cut : cuts_) {
    const auto first = triangles.begin() + static_cast<std::ptrdiff_t>(cut.first_corner / 3);
    fan.assign(first, first + static_cast<std::ptrdiff_t>(cut.count / 3));
    for (std::size_t i = 0; i < cut.count; ++i) {
      const std::uint32_t place = places_[cut.first_place + i];
      triangles[cut.first_corner / 3 + i / 3][i % 3] = fan[place / 3][place % 3];
    }
  }
}

void PolygonCuts::undo(std::vector<Triangle>& triangles) const {
  std::vector<std::uint32_t> corners;  // [corner of the polygon], vertices
  for (const Cut& cut : cuts_) {
    const std::size_t first = cut.first_corner / 3;
    corners.resize(cut.count / 3 + 2);
    for (std::size_t i = 0; i < cut.count; ++i) {
      const std::uint32_t place = places_[cut.first_place + i];
      corners[place < 2 ? place : (place - 2) / 3 + 2] = triangles[first + i / 3][i % 3];
    }
    for (std::size_t t = 0; t < cut.count / 3; ++t) {
      triangles[first + t] = {corners[0], corners[t + 1], corners[t + 2]};
    }
  }
}

bool cut_polygons(SingleMesh& mesh, const MeshLimit& limit) {
  if (!limit.cuts_polygons) return true;
  std::vector<std::array<double, 3>> corners;
  std::vector<std::uint32_t> split;
  std::size_t num_folded = 0;
  std::size_t max_corners = 0;
  for (const MeshPolygon& polygon : mesh.polygons) {
    // Memory for splitting a polygon, per corner, with its result.
    constexpr std::uint64_t kBytes = 150;
    if (!limit.leaves_room_for(mesh, kBytes * polygon.num_triangles)) return false;
    corners.clear();
    for (std::uint32_t k = 0; k < polygon.num_triangles + 2; ++k) {
      const std::uint64_t place = place_in_fan(k);
      const std::size_t v = mesh.triangles[polygon.first_triangle + place / 3][place % 3];
      corners.push_back({mesh.xyz[3 * v], mesh.xyz[3 * v + 1], mesh.xyz[3 * v + 2]});
    }
    split.clear();
    bool gave_up = false;
    for (const auto& triangle : split_polygon(corners, &gave_up)) {
      split.insert(split.end(), triangle.begin(), triangle.end());
    }
    if (!split.empty()) mesh.cuts.add(polygon, split);
    if (gave_up) {
      ++num_folded;
      max_corners = std::max<std::size_t>(max_corners, corners.size());
    }
  }
  if (num_folded > 0) {
    mesh.notes.push_back(
        count_text(num_folded, "polygon") + " of up to " + std::to_string(max_corners) +
        " corners would take too long to split: triangles fold over each other there; "
        "triangulate the mesh before encoding");
  }
  mesh.cuts.apply(mesh.triangles);
  return true;
}

}  // namespace rlpc
