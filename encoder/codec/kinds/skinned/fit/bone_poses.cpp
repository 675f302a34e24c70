#include "encoder/codec/kinds/skinned/fit/bone_poses.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "encoder/codec/math/matrix_products.h"

namespace rlpc {
SkinMoments::SkinMoments(std::size_t num_bones)
    : num_bones_(num_bones),
      block_(num_bones * num_bones, Eigen::Matrix4d::Zero()),
      sharing_(num_bones) {}

void SkinMoments::add(const Vec3d& rest, std::span<const RigWeight> weights) {
  const Eigen::Vector4d p = homogeneous(rest);
  const Eigen::Matrix4d products = p * p.transpose();
  for (const RigWeight& a : weights) {
    for (const RigWeight& b : weights) {
      Eigen::Matrix4d& block = block_[a.bone * num_bones_ + b.bone];
      const bool is_shared = block(3, 3) > 0.0;
      block += a.weight * b.weight * products;
      if (is_shared || !(block(3, 3) > 0.0)) continue;
      auto& list = sharing_[b.bone];
      list.insert(std::lower_bound(list.begin(), list.end(), a.bone), a.bone);
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
                      std::span<const Vec3d> trajectory) {
  static_assert(sizeof(Vec3d) == 3 * sizeof(double));
  const Eigen::Vector4d p = homogeneous(rest);
  const std::size_t size = Motion::ColsAtCompileTime * values_;
  for (const RigWeight& w : weights) {
    add_outer_product(w.weight, {p.data(), Motion::ColsAtCompileTime},
                      {trajectory.data()->data(), values_},
                      std::span(sum_).subspan(w.bone * size, size));
  }
}

std::vector<Motion> PoseTargets::frame_motions(std::size_t frame) const {
  std::vector<Motion> result(num_bones_);
  const double* sum = &sum_[3 * frame];
  for (Motion& m : result) {
    for (Eigen::Index k = 0; k < m.cols(); ++k, sum += values_) {
      m.col(k) = Vec3d(sum[0], sum[1], sum[2]);
    }
  }
  return result;
}

void refine_poses(const SkinMoments& moments, std::span<const Motion> targets,
                  std::vector<Motion>& motions) {
  for (std::size_t b = 0; b < motions.size(); ++b) {
    const double mass = moments.mass(b);
    if (!(mass > 0.0)) continue;
    Motion rest = targets[b];  // sum of w_b r (p, 1)^T, r the residual of all other bones
    for (const std::size_t c : moments.sharing(b)) {
      if (c != b) rest -= motions[c] * moments.block(c, b);
    }
    const Vec3d sum = moments.block(b, b).block<3, 1>(0, 3);
    const Eigen::Matrix3d h = rest.leftCols<3>() - rest.col(3) * sum.transpose() / mass;
    const Eigen::Matrix3d before = motions[b].leftCols<3>();
    const Eigen::Matrix3d r = closest_rotation(h, before);
    motions[b].leftCols<3>() = r;
    motions[b].col(3) = (rest.col(3) - r * sum) / mass;
  }
}

namespace {

using Twist = Eigen::Matrix<double, 6, 1>;  // a rotation vector and a translation

// Returns the sum of u x v over pairs (u, v), where k is the sum of v u^T.
Vec3d curl(const Eigen::Matrix3d& k) {
  return {k(2, 1) - k(1, 2), k(0, 2) - k(2, 0), k(1, 0) - k(0, 1)};
}

// Returns the sum over the vertices of w_b w_c J_b^T J_c. J = (-[R p]x, 1) is the derivative of
// the position R p + t with respect to a rotation vector, applied after R, and the translation
// t.
Eigen::Matrix<double, 6, 6> coupling(const Eigen::Matrix4d& moments, const Eigen::Matrix3d& rb,
                                     const Eigen::Matrix3d& rc) {
  const Eigen::Matrix3d n = rb * moments.topLeftCorner<3, 3>() * rc.transpose();
  Eigen::Matrix<double, 6, 6> a;
  a.topLeftCorner<3, 3>() = -n.transpose();
  a.topLeftCorner<3, 3>().diagonal().array() += n(0, 0) + n(1, 1) + n(2, 2);
  a.topRightCorner<3, 3>() = cross_matrix(rb * moments.block<3, 1>(0, 3));
  a.bottomLeftCorner<3, 3>() = -cross_matrix(rc * moments.block<3, 1>(0, 3));
  a.bottomRightCorner<3, 3>().setIdentity();
  a.bottomRightCorner<3, 3>() *= moments(3, 3);
  return a;
}

// The equations of a Gauss-Newton step. Bones that share no vertices are not coupled, so that
// the matrix has few blocks.
class StepEquations {
 public:
  StepEquations(const SkinMoments& moments, std::span<const Motion> motions)
      : moments_(moments) {
    constexpr double kDamping = 1e-3;  // fixed: part of the diagonal
    for (std::size_t b = 0; b < motions.size(); ++b) {
      first_.push_back(blocks_.size());
      for (const std::size_t c : moments.sharing(b)) {
        const Eigen::Matrix3d rb = motions[b].leftCols<3>();
        blocks_.push_back(coupling(moments.block(b, c), rb, motions[c].leftCols<3>()));
        if (c != b) continue;
        blocks_.back().diagonal() *= 1.0 + kDamping;
        add_inverse(blocks_.back());
      }
      if (inverse_.size() == b) inverse_.push_back(Block::Zero());
    }
  }

  // Solves by conjugate gradients, preconditioned with the inverses of the diagonal blocks.
  std::vector<Twist> solve(std::vector<Twist> left) const {
    constexpr int kMax = 30;           // fixed: steps; usually ten are enough
    constexpr double kMinPart = 1e-6;  // fixed: squared; another Gauss-Newton step follows
    std::vector<Twist> x(left.size(), Twist::Zero());
    std::vector<Twist> near = times_inverse(left);
    std::vector<Twist> along = near;
    double size = dot(left, near);
    const double min = kMinPart * size;
    for (int i = 0; i < kMax && size > min; ++i) {
      const std::vector<Twist> change = times(along);
      const double curvature = dot(along, change);
      if (!(curvature > 0.0)) break;
      const double by = size / curvature;
      for (std::size_t b = 0; b < x.size(); ++b) {
        x[b] += by * along[b];
        left[b] -= by * change[b];
      }
      near = times_inverse(left);
      const double before = size;
      size = dot(left, near);
      for (std::size_t b = 0; b < x.size(); ++b) along[b] = near[b] + size / before * along[b];
    }
    return x;
  }

 private:
  using Block = Eigen::Matrix<double, 6, 6>;

  // Adds the inverse of a block; unknowns without a pivot stay 0.
  void add_inverse(const Block& block) {
    inverse_.push_back(block.ldlt().solve(Block::Identity()));
  }
  std::vector<Twist> times_inverse(const std::vector<Twist>& x) const {
    std::vector<Twist> result(x.size());
    for (std::size_t b = 0; b < x.size(); ++b) result[b] = inverse_[b] * x[b];
    return result;
  }
  std::vector<Twist> times(const std::vector<Twist>& x) const {
    std::vector<Twist> result(x.size(), Twist::Zero());
    for (std::size_t b = 0; b < x.size(); ++b) {
      const Block* block = &blocks_[first_[b]];
      for (const std::size_t c : moments_.sharing(b)) result[b] += *block++ * x[c];
    }
    return result;
  }
  static double dot(const std::vector<Twist>& a, const std::vector<Twist>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
    return sum;
  }

  const SkinMoments& moments_;
  std::vector<std::size_t> first_;  // [bone], first of its blocks
  std::vector<Block> blocks_;       // bone by bone, with those of SkinMoments::sharing()
  std::vector<Block> inverse_;      // [bone], inverse of its own block
};

}  // namespace

void solve_poses(const SkinMoments& moments, std::span<const Motion> targets,
                 std::vector<Motion>& motions) {
  const std::size_t n = motions.size();
  std::vector<Twist> left(n);
  for (std::size_t b = 0; b < n; ++b) {
    Motion residual = targets[b];  // sum of w_b r (p, 1)^T, r the residual of all bones
    for (const std::size_t c : moments.sharing(b)) residual -= motions[c] * moments.block(c, b);
    const Eigen::Matrix3d rb = motions[b].leftCols<3>();
    left[b].head<3>() = curl(residual.leftCols<3>() * rb.transpose());
    left[b].tail<3>() = residual.col(3);
  }
  const std::vector<Twist> x = StepEquations(moments, motions).solve(std::move(left));
  for (std::size_t b = 0; b < n; ++b) {
    if (!(moments.mass(b) > 0.0)) continue;
    const Vec3d turn = x[b].head<3>();
    const Eigen::Matrix3d r =
        rotation_matrix(normalised({1.0, 0.5 * turn(0), 0.5 * turn(1), 0.5 * turn(2)}));
    motions[b].leftCols<3>() = r * motions[b].leftCols<3>();
    motions[b].col(3) += x[b].tail<3>();
  }
}

void fit_poses(const SkinMoments& moments, std::span<const Motion> targets,
               std::vector<Motion>& motions) {
  // tuned (off: 1): Rounds that fit the poses of a frame, of each of two methods. Poses that
  // have not converged leave more to trajectories.
  constexpr int kPoseRounds = 4;
  for (int i = 0; i < kPoseRounds; ++i) refine_poses(moments, targets, motions);
  for (int i = 0; i < kPoseRounds; ++i) solve_poses(moments, targets, motions);
}

}  // namespace rlpc
