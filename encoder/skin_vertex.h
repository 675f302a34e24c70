// The bones that a vertex follows, and its rest position, from sums over frames.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "encoder/rig.h"
#include "encoder/rigid_motion.h"

namespace rlpc {

using BoneMotions = std::vector<std::vector<Motion>>;  // [bone][frame]

// Sums over the frames of M_a^T M_b for all pairs of bones. With them, and with one sum for
// each bone that a vertex may follow, errors, weights and rest positions need no frames.
class MotionProducts {
 public:
  explicit MotionProducts(const BoneMotions& motions);

  const Eigen::Matrix4d& operator()(std::size_t a, std::size_t b) const {
    return product_[a * num_bones_ + b];
  }

 private:
  std::size_t num_bones_;
  std::vector<Eigen::Matrix4d> product_;
};

// One vertex, and the bones that it may follow.
class SkinVertex {
 public:
  static constexpr std::size_t kMaxCandidates = 8;

  SkinVertex() = default;
  // candidates: at most kMaxCandidates; the motions are those of the products.
  SkinVertex(std::span<const Vec3d> positions, const BoneMotions& motions,
             std::span<const std::size_t> candidates);

  std::span<const std::size_t> candidates() const { return {bone_.data(), size_}; }

  // Squared error over the frames of the vertex at `rest` for all pairs of candidates, as the
  // Gram matrix of their errors; [kMaxCandidates * kMaxCandidates].
  using Gram = std::array<double, kMaxCandidates * kMaxCandidates>;
  Gram gram(const MotionProducts& products, const Vec3d& rest) const;

  // The rest position with the least error, held weakly near `before`.
  Vec3d fit_rest(const MotionProducts& products, const Vec3d& before,
                 std::span<const RigWeight> weights) const;

 private:
  std::size_t place_of(std::size_t bone) const;

  std::size_t size_ = 0;
  std::size_t num_frames_ = 0;
  double square_ = 0.0;  // of all positions
  std::array<std::size_t, kMaxCandidates> bone_{};
  std::array<Eigen::Vector4d, kMaxCandidates> sum_;  // of M^T x
};

// The squared error of a vertex that follows one bone.
double rigid_error(std::span<const Vec3d> positions, const Vec3d& rest,
                   const std::vector<Motion>& motion);

// The rest position with the least error of a vertex that follows one bone, the best one.
Vec3d single_rest(std::span<const Vec3d> positions, const BoneMotions& motions);

// The bones that suit a vertex best by themselves, the best first.
std::vector<std::size_t> closest_bones(std::span<const Vec3d> positions, const Vec3d& rest,
                                       const BoneMotions& motions, std::size_t count);

}  // namespace rlpc
