// Errors, weights and rest positions of vertices that follow bones, from sums over frames.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "encoder/skinned_gof/fit/rig.h"
#include "encoder/skinned_gof/fit/rigid_motion.h"

namespace rlpc {

using BoneMotions = std::vector<std::vector<Motion>>;  // [bone][frame]

// The sums over the frames of M_a^T M_b for all pairs of bones, and of M_b^T x for some
// vertices and all bones. Those of a bone are the same to the bit whatever others there are.
class SkinSums {
 public:
  // positions: [vertex][frame], as many frames as the motions have; kept by reference
  SkinSums(std::span<const Vec3d> positions, const BoneMotions& motions);

  // As if made with others; faster by what stays.
  void set_positions(std::span<const Vec3d> positions);
  void set_motions(const BoneMotions& motions);
  void add_bone(const std::vector<Motion>& motion);  // behind the others
  void remove_bone(std::size_t bone);

  // The squared error of a vertex that follows one bone.
  double rigid_error(std::size_t vertex, std::size_t bone, const Vec3d& rest) const;
  // The rest position with the least error of a vertex that follows one bone, the best one.
  Vec3d single_rest(std::size_t vertex) const;
  // The bones that suit a vertex best by themselves, the best first.
  std::vector<std::size_t> closest_bones(std::size_t vertex, const Vec3d& rest,
                                         std::size_t count) const;

  // Squared error of a vertex at `rest` for all pairs of some bones, as the Gram matrix of
  // their errors; [kMaxCandidates * kMaxCandidates].
  static constexpr std::size_t kMaxCandidates = 8;  // fixed: size of arrays
  using Gram = std::array<double, kMaxCandidates * kMaxCandidates>;
  Gram gram(std::size_t vertex, std::span<const std::size_t> bones, const Vec3d& rest) const;

  // The rest position with the least error, held weakly near `before`.
  Vec3d fit_rest(std::size_t vertex, const Vec3d& before,
                 std::span<const RigWeight> weights) const;

 private:
  void sum_along();
  const Eigen::Matrix4d& product(std::size_t a, std::size_t b) const {
    return product_[a * num_bones_ + b];
  }
  Eigen::Vector4d along(std::size_t vertex, std::size_t bone) const {
    const double* sum = &along_[(vertex * num_bones_ + bone) * 4];
    return {sum[0], sum[1], sum[2], sum[3]};
  }

  std::size_t num_bones_ = 0;
  std::size_t num_frames_;
  std::span<const double> positions_;     // [vertex][frame][3]
  std::vector<double> by_frame_;          // the motions: [frame][3][bone][4]
  std::vector<Eigen::Matrix4d> product_;  // [bone][bone]
  std::vector<double> along_;             // [vertex][bone][4]
  std::vector<double> square_;            // [vertex], of all positions
};

}  // namespace rlpc
