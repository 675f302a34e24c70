// Normals that follow from positions (F.8): faces, and the normal of a sector.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/attributes/recon/corner_geometry.h"
#include "common/codec/attributes/sectors.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::uint32_t kMaxFaceTriangles = 64;

// Faces of triangles, and FaceNormal of each face.
struct FaceView {
  std::span<const std::uint32_t> face_of;
  std::span<const Vec3l> normals;

  const Vec3l& normal_at(std::uint32_t c) const { return normals[face_of[c / 3]]; }
};

// F.8.1 Faces
class Faces {
 public:
  // seams: may be empty. Without normals, only Diagonals::kLikely needs positions.
  Faces(const CornerGeometry& geometry, Diagonals diagonals,
        std::span<const std::uint32_t> edge_mates, const Vector<bool>& seams,
        const Vector<bool>& flags, bool with_normals);

  FaceView view() const { return {face_of_, normals_}; }
  Vector<std::uint32_t>& face_of_triangle() { return face_of_; }

 private:
  std::uint32_t root(std::uint32_t t) const {
    while (face_of_[t] != t) t = face_of_[t];
    return t;
  }

  Vector<std::uint32_t> face_of_;
  Vector<Vec3l> normals_;  // [triangle]; the normal of a face is at its lowest triangle
};

// Point of the unfolded octahedron.
using OctahedronPoint = std::array<std::int64_t, 2>;

// F.8.4 OctahedralOf( ); value_bits: 2 to 16.
OctahedronPoint octahedral_of(const Vec3l& normal, std::uint32_t value_bits);

// F.8.3 SectorNormal( ), of any length, from the corners of a sector.
Vec3l sector_normal(const CornerGeometry& geometry, const FaceView& faces,
                    SmoothingWeight weight, std::span<const std::uint32_t> corners);

}  // namespace rlpc
