// Compares the faces of two meshes, whatever their order and first corners.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/meshes/polygon_cuts.h"

namespace rlpc {

// Faces as fans of triangles. polygons: the faces of more than one triangle, in order.
struct FaceList {
  std::span<const Triangle> triangles;
  std::span<const MeshPolygon> polygons;
};

// A face that one of two meshes has more often than the other.
struct OddFace {
  std::vector<std::uint32_t> vertices;
  bool is_of_first = false;
};

// Returns, for each corner of the triangles of `first`, the corner of those of `other` that is
// the same corner of the same face; or a face without counterpart. Faces are the same if they
// have the same vertices in the same cyclic order.
//
// Needs about kMatchBytes for each triangle of both, and n * log n time.
inline constexpr std::uint64_t kMatchBytes = 40;
std::variant<std::vector<std::uint32_t>, OddFace> match_faces(const FaceList& first,
                                                              const FaceList& other);

}  // namespace rlpc
