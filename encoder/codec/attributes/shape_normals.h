// Normals that follow from a shape (F.8), as floats.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/attributes/recon/normals.h"
#include "common/codec/attributes/sectors.h"
#include "encoder/codec/attributes/smoothing_search.h"

namespace rlpc {

using Vec3d = std::array<double, 3>;

double dot(const Vec3d& a, const Vec3d& b);
inline bool is_zero(const Vec3d& v) { return dot(v, v) == 0.0; }
// Scales a vector to length 1; zero stays zero.
Vec3d normalised(Vec3d v);
// Returns the angle between unit vectors, in radians; the same on every machine.
double angle_between(const Vec3d& a, const Vec3d& b);

// The normals of sectors.
class ShapeNormals {
 public:
  // geometry and sectors must outlive it.
  ShapeNormals(const CornerGeometry& geometry, const Sectors& sectors,
               std::span<const std::uint32_t> edge_mates, const std::vector<bool>& seams,
               const Smoothing& smoothing);

  // Returns the normal of a sector, of length 1, or zero.
  Vec3d normal(std::uint32_t x) const;

 private:
  const CornerGeometry& geometry_;
  const Sectors& sectors_;
  SmoothingWeight weight_;
  Faces faces_;
};

}  // namespace rlpc
