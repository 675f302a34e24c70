// Errors, weights and rest positions of skinned vertices, from sums over the frames.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"
#include "encoder/codec/spans/rig.h"

namespace rlpc {

using BoneMotions = std::vector<std::vector<Motion>>;  // [bone][frame]

// Sums over the frames of M_a^T M_b for all pairs of bones, and of M_b^T x for all bones and
// some vertices. The sums of a bone do not depend on other bones, to the last bit.
class SkinSums {
 public:
  // positions: [vertex][frame], with the frames of the motions; kept by reference.
  SkinSums(std::span<const Vec3d> positions, const BoneMotions& motions);

  // Compute the same sums as the constructor, but faster.
  void set_positions(std::span<const Vec3d> positions);
  void set_motions(const BoneMotions& motions);
  // Does the same, but sums for a vertex only over some bones, [vertex].
  void set_motions(const BoneMotions& motions, std::span<const std::vector<std::size_t>> bones);
  void add_bone(const std::vector<Motion>& motion);  // appends a bone
  void remove_bone(std::size_t bone);

  // Returns the squared error of a vertex that follows a single bone.
  double rigid_error(std::size_t vertex, std::size_t bone, const Vec3d& rest) const;
  // Returns the optimal rest position of a vertex that follows only its best bone.
  Vec3d single_rest(std::size_t vertex) const;
  // Returns the `count` bones with the smallest rigid_error(), in ascending order.
  std::vector<std::size_t> closest_bones(std::size_t vertex, const Vec3d& rest,
                                         std::size_t count) const;

  // Returns the Gram matrix of the errors of a vertex at `rest` under each of some bones.
  static constexpr std::size_t kMaxCandidates = 8;  // fixed: size of arrays
  using Gram = std::array<double, kMaxCandidates * kMaxCandidates>;
  Gram gram(std::size_t vertex, std::span<const std::size_t> bones, const Vec3d& rest) const;

  // Returns the rest position with the smallest error, regularised weakly towards `before`.
  Vec3d fit_rest(std::size_t vertex, const Vec3d& before,
                 std::span<const RigWeight> weights) const;

 private:
  void sum_along();
  void sum_products(const BoneMotions& motions);
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
  std::vector<double> square_;            // [vertex], sum of its squared positions
};

}  // namespace rlpc
