#include "encoder/codec/kinds/skinned/recover/placed_bones.h"

#include <algorithm>

namespace rlpc {

Eigen::Matrix3d small_rotation(const Vec3d& axis) {
  return rotation_matrix(normalised({1.0, 0.5 * axis(0), 0.5 * axis(1), 0.5 * axis(2)}));
}

PlacedBones::PlacedBones(const BoneSpace& space, const BoneChains& chains) : space_(&space) {
  const std::size_t n = space.num_bones();
  turn_.assign(n, Eigen::Matrix3d::Identity());
  for (const BoneChains::Bone& bone : chains.bones) pivot_.push_back(bone.pivot);
  first_ = pivot_;
  place();
}

void PlacedBones::move(std::span<const double> by) {
  for (std::size_t b = 0; b < turn_.size(); ++b) {
    const double* x = &by[b * kUnknowns];
    turn_[b] *= small_rotation(Vec3d(x[0], x[1], x[2]));
    pivot_[b] += Vec3d(x[3], x[4], x[5]);
  }
  place();
}

void PlacedBones::put(std::size_t bone, const Eigen::Matrix3d& turn, const Vec3d& pivot) {
  turn_[bone] = turn;
  pivot_[bone] = pivot;
  place();
}

void PlacedBones::move_rest(std::span<const std::size_t> bones, const Eigen::Matrix3d& rotation,
                            const Vec3d& from, const Vec3d& to) {
  for (const std::size_t b : bones) {
    pivot_[b] = to + rotation.transpose() * (pivot_[b] - from);
    turn_[b] *= rotation;
  }
  place();
}

void PlacedBones::place() {
  const std::size_t width = space_->width();
  base_.assign(turn_.size() * width, 0.0);
  for (const std::size_t b : space_->order()) {
    double* base = &base_[b * width];
    if (space_->is_anchored(b)) {
      base[space_->origin(b)] = 1.0;
      continue;
    }
    const std::size_t parent = space_->parent(b);
    std::copy_n(&base_[parent * width], width, base);
    const Vec3d along = turn_[parent] * (pivot_[b] - pivot_[parent]);
    first_[b] = first_[parent] + along;
    for (std::size_t c = 0; c < 3; ++c) {
      base[space_->block(parent) + c] += along(static_cast<Eigen::Index>(c));
    }
  }
}

void PlacedBones::add_moved(const BoneSpace::Part& part, std::size_t bone, const Vec3d& rest,
                            double weight, std::vector<double>& to) const {
  const double* base = &base_[bone * space_->width()];
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += weight * base[part.coordinates[i]];
  const Vec3d along = turn_[bone] * (rest - pivot_[bone]);
  const std::size_t at = part.place(bone);
  for (std::size_t c = 0; c < 3; ++c)
    to[at + c] += weight * along(static_cast<Eigen::Index>(c));
}

}  // namespace rlpc
