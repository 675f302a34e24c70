#include "encoder/codec/kinds/skinned/fit/bone_stretch.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/small_system.h"

namespace rlpc {
namespace {

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

Eigen::Matrix3d matrix_of(const AxisImages& images) {
  Eigen::Matrix3d matrix;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) matrix(index(c), index(k)) = images[k][c];
  }
  return matrix;
}

Eigen::Matrix3d matrix_of(const BoneAxes& decoded) {
  const double unit = exact_exp2(-kQuaternionFractionBits);
  Eigen::Matrix3d matrix;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      matrix(index(c), index(k)) = static_cast<double>(decoded[k][c]) * unit;
    }
  }
  return matrix;
}

AxisImages images_of(const Eigen::Matrix3d& matrix) {
  AxisImages images;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) images[k][c] = matrix(index(c), index(k));
  }
  return images;
}

Eigen::Matrix3d quotient(const Eigen::Matrix3d& after, const Eigen::Matrix3d& whole,
                         const Eigen::Matrix3d& before) {
  constexpr double kFlat = 1e-8;  // fixed: squared; rounding errors of axes are 1e-9
  Eigen::Matrix3d quotient = Eigen::Matrix3d::Zero();
  for (std::size_t column = 0; column < 3; ++column) {
    SmallSystem<3> m;  // normal equations
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        m.a[i][k] = after.col(index(i)).dot(after.col(index(k)));
      }
      m.a[i][i] += kFlat;
      m.b[i] = after.col(index(i)).dot(whole.col(index(column))) +
               kFlat * before(index(i), index(column));
    }
    const auto solution = solve_small(m);
    if (!solution.is_unique) continue;
    for (std::size_t i = 0; i < 3; ++i) quotient(index(i), index(column)) = solution.x[i];
  }
  return quotient;
}

Eigen::Matrix3d rotation_of(const Eigen::Matrix3d& map, const Eigen::Matrix3d& before) {
  constexpr double kFlat = 1e-9;  // fixed: rounding errors of axes
  return closest_rotation(map + kFlat * before, before);
}

std::array<double, 3> stretch_along(const Eigen::Matrix3d& along,
                                    const Eigen::Matrix3d& rotation,
                                    const Eigen::Matrix3d& map) {
  const Eigen::Matrix3d stretch = rotation.transpose() * map;
  std::array<double, 3> factors{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d axis = along.col(index(i));
    factors[i] = axis.dot(Vec3d(stretch * axis));
  }
  return factors;
}

Eigen::Matrix3d common_axes(std::span<const Eigen::Matrix3d> symmetric) {
  constexpr int kSweeps = 8;  // fixed: converged long before, as the order is 3
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Eigen::Index p = 0; p < 3; ++p) {
      const Eigen::Index q = (p + 1) % 3;
      double on = 0.0;
      double off = 0.0;
      for (const Eigen::Matrix3d& s : symmetric) {
        const Vec3d sp = s * axes.col(p);
        const Vec3d sq = s * axes.col(q);
        const double difference = axes.col(p).dot(sp) - axes.col(q).dot(sq);
        const double twice = 2.0 * axes.col(p).dot(sq);
        on += difference * difference - twice * twice;
        off += 2.0 * difference * twice;
      }
      // The angle is a quarter of that of (on, off): halve it twice.
      const double length = std::sqrt(on * on + off * off);
      if (!(length > 0.0)) continue;
      const double cos4 = on / length;
      const double cos2 = std::sqrt(std::max(0.5 * (1.0 + cos4), 0.0));
      const double sin2 = cos4 > 0.0 ? 0.5 * off / (length * cos2)
                                     : std::copysign(std::sqrt(0.5 * (1.0 - cos4)), off);
      const double cosine = std::sqrt(0.5 * (1.0 + cos2));
      const double sine = 0.5 * sin2 / cosine;
      const Vec3d first = axes.col(p);
      const Vec3d second = axes.col(q);
      axes.col(p) = cosine * first + sine * second;
      axes.col(q) = cosine * second - sine * first;
    }
  }
  return axes;
}

}  // namespace rlpc
