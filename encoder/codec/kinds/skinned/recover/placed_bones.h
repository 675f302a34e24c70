// Where bones are in the rest shape.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_chains.h"
#include "encoder/codec/kinds/skinned/recover/bone_space.h"

namespace rlpc {

// Returns a rotation about an axis: by its length, if that is small.
Eigen::Matrix3d small_rotation(const Vec3d& axis);

// The unknowns of bones; BoneSpace says what they mean.
class PlacedBones {
 public:
  // Starts with the first frame as the rest shape. Keeps a reference to the space.
  PlacedBones(const BoneSpace& space, const BoneChains& chains);

  const Eigen::Matrix3d& turn(std::size_t bone) const { return turn_[bone]; }
  const Vec3d& pivot(std::size_t bone) const { return pivot_[bone]; }
  const BoneSpace& space() const { return *space_; }

  // Returns the coordinates of the pivot of a bone that has a place: [space().width()].
  std::span<const double> coordinates_of_pivot(std::size_t bone) const {
    return std::span(base_).subspan(bone * space_->width(), space_->width());
  }
  // Returns the rest position of a point that a bone moves to a place in the first frame.
  Vec3d rest_of(std::size_t bone, const Vec3d& place) const {
    return pivot_[bone] + turn_[bone].transpose() * (place - first_[bone]);
  }

  // Gives a bone a turn and a pivot.
  void put(std::size_t bone, const Eigen::Matrix3d& turn, const Vec3d& pivot);
  // Moves a part of the rest shape: what was at `from` is then at `to`, turned by the inverse
  // of a rotation.
  //
  //   bones  those that move this part; vertices that follow no others stay where they are in
  //          all frames
  void move_rest(std::span<const std::size_t> bones, const Eigen::Matrix3d& rotation,
                 const Vec3d& from, const Vec3d& to);

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
  std::vector<Eigen::Matrix3d> turn_;
  std::vector<Vec3d> pivot_;
  std::vector<Vec3d> first_;  // [bone], its pivot in the first frame
  std::vector<double> base_;  // [bone][width], coordinates of its pivot
};

}  // namespace rlpc
