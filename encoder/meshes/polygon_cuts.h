// The triangles of polygons that a fan does not cover.
#pragma once

#include <cstdint>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

struct SingleMesh;
struct MeshLimit;

// Triangles that were one face of a file; when read, a fan from its first corner.
struct MeshPolygon {
  std::uint64_t first_triangle = 0;
  std::uint32_t num_triangles = 0;  // 2 or more
};

// Returns the place of a corner of a polygon among the corners of its fan, three for each
// triangle.
constexpr std::uint64_t place_in_fan(std::uint64_t corner) {
  return corner < 2 ? corner : 3 * (corner - 2) + 2;
}

// Replaces fans by other triangles, in lists with an element for each corner of triangles.
class PolygonCuts {
 public:
  // Whether no polygon needs other triangles than its fan.
  bool empty() const { return cuts_.empty(); }
  std::uint64_t memory_bytes() const {
    return cuts_.capacity() * sizeof(Cut) + places_.capacity() * sizeof(places_[0]);
  }

  // Adds the triangles of a polygon, by corner.
  void add(const MeshPolygon& polygon, const std::vector<std::uint32_t>& corners);

  void apply(std::vector<Triangle>& triangles) const;
  // Makes fans of these triangles again.
  void undo(std::vector<Triangle>& triangles) const;
  // corners: three elements for each triangle; an empty list stays as it is.
  void apply(std::vector<std::uint32_t>& corners) const;

 private:
  struct Cut {
    std::uint64_t first_corner = 0;  // 3 * triangle
    std::uint64_t first_place = 0;   // in places_
    std::uint64_t count = 0;         // number of corners, and of places
  };
  std::vector<Cut> cuts_;
  std::vector<std::uint32_t> places_;  // source of an element, relative to first_corner
};

// Finds the polygons of a mesh whose fans, at the positions of this mesh, fold or leave them,
// and replaces their triangles; lists of corners are left to the caller. The mesh must be
// complete except for attributes. Does nothing unless the limit has cuts_polygons. False: too
// much memory.
bool cut_polygons(SingleMesh& mesh, const MeshLimit& limit);

}  // namespace rlpc
