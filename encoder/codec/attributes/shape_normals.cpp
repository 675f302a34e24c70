#include "encoder/codec/attributes/shape_normals.h"

#include <cmath>

#include "common/codec/mesh/corners.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

double dot(const Vec3d& a, const Vec3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3d normalised(Vec3d v) {
  const double length = std::sqrt(dot(v, v));
  for (double& x : v) x = length > 0.0 ? x / length : 0.0;
  return v;
}

double angle_between(const Vec3d& a, const Vec3d& b) {
  const Vec3d across = cross(a, b);
  const double sine = std::sqrt(dot(across, across));
  const double cosine = dot(a, b);
  const double size = std::abs(cosine);
  constexpr double kHalfPi = 1.5707963267948966;
  if (sine == 0.0 && size == 0.0) return 0.0;
  const double angle = sine <= size ? det_atan(sine / size) : kHalfPi - det_atan(size / sine);
  return cosine < 0.0 ? 2.0 * kHalfPi - angle : angle;
}

ShapeNormals::ShapeNormals(const CornerGeometry& geometry, const Sectors& sectors,
                           std::span<const std::uint32_t> edge_mates,
                           const std::vector<bool>& seams, const Smoothing& smoothing)
    : geometry_(geometry),
      sectors_(sectors),
      weight_(smoothing.weight),
      faces_(geometry, Diagonals::kFlagged, edge_mates, seams, smoothing.is_diagonal, true) {}

Vec3d ShapeNormals::normal(std::uint32_t x) const {
  const Vec3l sum = sector_normal(geometry_, faces_.view(), weight_, sectors_.corners[x]);
  return normalised(
      {static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])});
}

}  // namespace rlpc
