#include "encoder/bone_poses.h"

#include <algorithm>

namespace rlpc {
namespace {

using Column4 = Eigen::Vector4d;

Column4 homogeneous(const Vec3d& p) { return {p(0), p(1), p(2), 1.0}; }

}  // namespace

SkinMoments::SkinMoments(std::size_t num_bones)
    : num_bones_(num_bones), block_(num_bones * num_bones, Eigen::Matrix4d::Zero()) {}

void SkinMoments::add(const Vec3d& rest, std::span<const RigWeight> weights) {
  const Column4 p = homogeneous(rest);
  const Eigen::Matrix4d products = p * p.transpose();
  for (const RigWeight& a : weights) {
    for (const RigWeight& b : weights) {
      block_[a.bone * num_bones_ + b.bone] += a.weight * b.weight * products;
    }
  }
}

Vec3d SkinMoments::centre(std::size_t bone) const {
  if (mass(bone) == 0.0) return Vec3d::Zero();
  return block(bone, bone).block<3, 1>(0, 3) / mass(bone);
}

double SkinMoments::spread2(std::size_t bone) const {
  if (mass(bone) == 0.0) return 0.0;
  const Eigen::Matrix4d& m = block(bone, bone);
  const double about_origin = (m(0, 0) + m(1, 1) + m(2, 2)) / mass(bone);
  return std::max(about_origin - centre(bone).squaredNorm(), 0.0);
}

void PoseTargets::add(const Vec3d& rest, std::span<const RigWeight> weights,
                      const Vec3d& position) {
  const Motion products = position * homogeneous(rest).transpose();
  for (const RigWeight& a : weights) sum_[a.bone] += a.weight * products;
}

void refine_poses(const SkinMoments& moments, const PoseTargets& targets,
                  std::vector<Motion>& motions) {
  for (std::size_t b = 0; b < motions.size(); ++b) {
    const double mass = moments.mass(b);
    if (!(mass > 0.0)) continue;
    Motion left = targets[b];  // sum of w_b (what the others leave) (p, 1)^T
    for (std::size_t c = 0; c < motions.size(); ++c) {
      const Eigen::Matrix4d& m = moments.block(c, b);
      if (c != b && m(3, 3) > 0.0) left -= motions[c] * m;
    }
    const Vec3d sum = moments.block(b, b).block<3, 1>(0, 3);
    const Eigen::Matrix3d h = left.leftCols<3>() - left.col(3) * sum.transpose() / mass;
    const Eigen::Matrix3d before = motions[b].leftCols<3>();
    const Eigen::Matrix3d r = closest_rotation(h, before);
    motions[b].leftCols<3>() = r;
    motions[b].col(3) = (left.col(3) - r * sum) / mass;
  }
}

}  // namespace rlpc
