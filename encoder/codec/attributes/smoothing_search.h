// Finds how normals follow from positions (F.8): which edges are diagonals of faces, and how
// faces are weighted.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/attributes/recon/normals.h"
#include "common/codec/attributes/sectors.h"

namespace rlpc {

struct SmoothingMesh {
  const CornerGeometry& geometry;
  std::span<const std::uint32_t> edge_mates;
  const std::vector<bool>& seams;  // empty: none
  const Sectors& sectors;
};

struct Smoothing {
  SmoothingWeight weight = SmoothingWeight::kAngle;
  std::vector<bool> is_diagonal;  // [edge]; faces have at most kMaxFaceTriangles
  double bits = 0.0;              // approximate cost of residuals and diagonals
};

// wanted: [sector], points of an octahedron of value_bits. Takes some passes over the
// triangles.
Smoothing find_smoothing(const SmoothingMesh& mesh,
                         std::span<const std::array<std::uint32_t, 2>> wanted,
                         std::uint32_t value_bits);

}  // namespace rlpc
