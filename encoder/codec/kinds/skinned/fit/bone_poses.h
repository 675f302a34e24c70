// Solves for the poses of all bones in a frame, from sums over the vertices that follow them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/bone_weights.h"
#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"

namespace rlpc {

// Sums over the vertices of w_a w_b (p, 1) (p, 1)^T, for all pairs of bones a, b. Together with
// the PoseTargets of a frame they give its squared error as a quadratic function of the bone
// motions, so the time to solve for poses does not depend on the number of vertices.
class SkinMoments {
 public:
  explicit SkinMoments(std::size_t num_bones);
  void add(const Vec3d& rest, std::span<const RigWeight> weights);

  std::size_t num_bones() const { return num_bones_; }
  // Returns the bones with which a bone shares vertices, itself included, ascending.
  const std::vector<std::size_t>& sharing(std::size_t bone) const { return sharing_[bone]; }
  const Eigen::Matrix4d& block(std::size_t a, std::size_t b) const {
    return block_[a * num_bones_ + b];
  }
  double mass(std::size_t bone) const { return block(bone, bone)(3, 3); }  // sum of w^2
  Vec3d centre(std::size_t bone) const;
  double spread2(std::size_t bone) const;  // mean squared distance from the centre

 private:
  std::size_t num_bones_;
  std::vector<Eigen::Matrix4d> block_;
  std::vector<std::vector<std::size_t>> sharing_;  // [bone]
};

// Sums over the vertices of w_b x (p, 1)^T, for all bones in some frames; x is the position of
// the vertex in the frame, p its rest position.
class PoseTargets {
 public:
  PoseTargets(std::size_t num_bones, std::size_t num_frames)
      : num_bones_(num_bones),
        values_(3 * num_frames),
        sum_(num_bones * Motion::ColsAtCompileTime * values_, 0.0) {}
  // trajectory: [frame]
  void add(const Vec3d& rest, std::span<const RigWeight> weights,
           std::span<const Vec3d> trajectory);
  std::vector<Motion> frame_motions(std::size_t frame) const;  // [bone]

 private:
  std::size_t num_bones_;
  std::size_t values_;       // values of a trajectory
  std::vector<double> sum_;  // [bone][column][frame][3]
};

// Lowers the squared error of a frame by giving each bone in turn the best motion while the
// others are fixed. targets: PoseTargets::frame_motions().
void refine_poses(const SkinMoments& moments, std::span<const Motion> targets,
                  std::vector<Motion>& motions);

// Lowers the squared error with one Gauss-Newton step for all bones together: slower, but it
// converges where vertices follow several bones. The motions must already be close.
void solve_poses(const SkinMoments& moments, std::span<const Motion> targets,
                 std::vector<Motion>& motions);

// Calls both in turn until the motions have converged. They may start from those of a frame
// nearby.
void fit_poses(const SkinMoments& moments, std::span<const Motion> targets,
               std::vector<Motion>& motions);

}  // namespace rlpc
