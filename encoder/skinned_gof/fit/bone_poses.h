// The poses of all bones in a frame at once, from sums over the vertices they move.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "encoder/skinned_gof/fit/bone_weights.h"
#include "encoder/skinned_gof/fit/rigid_motion.h"

namespace rlpc {

// Sums of w_a w_b (p, 1) (p, 1)^T over the vertices for all pairs of bones. With them, and with
// PoseTargets of the frame, the squared error of a frame is a quadratic in the bones' motions:
// finding poses costs the same for any number of vertices.
class SkinMoments {
 public:
  explicit SkinMoments(std::size_t num_bones);
  void add(const Vec3d& rest, std::span<const RigWeight> weights);

  std::size_t num_bones() const { return num_bones_; }
  const Eigen::Matrix4d& block(std::size_t a, std::size_t b) const {
    return block_[a * num_bones_ + b];
  }
  double mass(std::size_t bone) const { return block(bone, bone)(3, 3); }  // sum of w^2
  Vec3d centre(std::size_t bone) const;
  double spread2(std::size_t bone) const;  // mean squared distance to the centre

 private:
  std::size_t num_bones_;
  std::vector<Eigen::Matrix4d> block_;
};

// Sums of w_b x (p, 1)^T over the vertices at positions x, for all bones in some frames.
class PoseTargets {
 public:
  PoseTargets(std::size_t num_bones, std::size_t num_frames)
      : num_bones_(num_bones),
        values_(3 * num_frames),
        sum_(num_bones * Motion::ColsAtCompileTime * values_, 0.0) {}
  // trajectory: [frame]
  void add(const Vec3d& rest, std::span<const RigWeight> weights,
           std::span<const Vec3d> trajectory);
  std::vector<Motion> of_frame(std::size_t frame) const;  // [bone]

 private:
  std::size_t num_bones_;
  std::size_t values_;       // of a trajectory
  std::vector<double> sum_;  // [bone][column][frame][3]
};

// Lowers the squared error of a frame: each bone in turn takes the best motion that the others
// leave it. targets: PoseTargets of the frame.
void refine_poses(const SkinMoments& moments, std::span<const Motion> targets,
                  std::vector<Motion>& motions);

// The same for all bones at once, by a step of Gauss and Newton: slower, but it gets there
// where vertices follow several bones. The motions must be near already.
void solve_poses(const SkinMoments& moments, std::span<const Motion> targets,
                 std::vector<Motion>& motions);

}  // namespace rlpc
