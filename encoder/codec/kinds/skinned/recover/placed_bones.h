// Where bones are in the rest shape.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_chains.h"
#include "encoder/codec/kinds/skinned/recover/bone_space.h"

namespace rlpc {

// The unknowns of bones; BoneSpace says what they mean.
class PlacedBones {
 public:
  // Starts with the first frame as the rest shape. Keeps a reference to the space.
  PlacedBones(const BoneSpace& space, const BoneChains& chains);

  const Eigen::Matrix3d& turn(std::size_t bone) const { return turn_[bone]; }
  const Vec3d& pivot(std::size_t bone) const { return pivot_[bone]; }
  const BoneSpace& space() const { return *space_; }

  static constexpr std::size_t kUnknowns = 6;  // fixed: a rotation vector, and the pivot
  // Changes all unknowns. by: [bone][kUnknowns], turns and pivots
  void move(std::span<const double> by);

  // Adds the coordinates of a rest position that follows one bone, times a weight.
  // to: [part.size()]
  void add_moved(const BoneSpace::Part& part, std::size_t bone, const Vec3d& rest,
                 double weight, std::vector<double>& to) const;

 private:
  void place();

  const BoneSpace* space_;
  std::vector<std::size_t> order_;  // parents first
  std::vector<Eigen::Matrix3d> turn_;
  std::vector<Vec3d> pivot_;
  std::vector<double> base_;  // [bone][width], coordinates of its pivot
};

}  // namespace rlpc
