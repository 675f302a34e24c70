#include "encoder/codec/kinds/skinned/recover/bone_space.h"

#include <algorithm>
#include <utility>

#include "encoder/codec/math/matrix_products.h"

namespace rlpc {
namespace {

void insert(std::vector<std::uint32_t>& list, std::uint32_t x) {
  const auto at = std::lower_bound(list.begin(), list.end(), x);
  if (at == list.end() || *at != x) list.insert(at, x);
}

std::vector<double> values_of(std::span<const Vec3d> trajectory) {
  std::vector<double> values;
  for (const Vec3d& p : trajectory) values.insert(values.end(), p.data(), p.data() + 3);
  return values;
}

}  // namespace

BoneSpace::BoneSpace(const Trajectories& trajectories, const BoneRotations& rotations,
                     const BoneChains& chains)
    : t_(trajectories),
      num_bones_(rotations.bones.size()),
      path_(num_bones_),
      origin_(num_bones_, 0) {
  for (const std::size_t b : chains.order) {
    if (chains.bones[b].anchors.empty()) continue;
    path_[b] = {static_cast<std::uint32_t>(b)};
    origin_[b] = order_.size();
    order_.push_back(b);
  }
  const std::vector<std::vector<double>> columns = columns_of(rotations, chains);
  width_ = columns.size();
  const std::size_t rows = 3 * t_.num_frames();
  columns_.resize(rows * width_);
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t k = 0; k < width_; ++k) columns_[r * width_ + k] = columns[k][r];
  }
  gram_ = gram_matrix(columns_, width_);
  for (std::size_t i = 0; i < width_; ++i) {
    for (std::size_t j = 0; j < i; ++j) gram_[j * width_ + i] = gram_[i * width_ + j];
  }
}

void BoneSpace::hang(std::size_t bone, std::size_t parent) {
  path_[bone] = path_[parent];
  path_[bone].push_back(static_cast<std::uint32_t>(bone));
  origin_[bone] = origin_[parent];
  order_.push_back(bone);
}

void BoneSpace::let_go(std::size_t bone) {
  path_[bone].clear();
  order_.pop_back();
}

std::vector<std::vector<double>> BoneSpace::columns_of(const BoneRotations& rotations,
                                                       const BoneChains& chains) const {
  std::vector<std::vector<double>> columns;
  for (const BoneRotation& bone : rotations.bones) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      std::vector<double>& column = columns.emplace_back();
      for (const Eigen::Matrix3d& r : bone.rotation) {
        for (Eigen::Index c = 0; c < 3; ++c) column.push_back(r(c, j));
      }
    }
  }
  for (const std::size_t b : order_) {
    const auto& anchors = chains.bones[b].anchors;
    std::vector<double>& column = columns.emplace_back();
    for (std::size_t f = 0; f < t_.num_frames(); ++f) {
      const Vec3d mean = t_.mean(f, anchors);
      column.insert(column.end(), mean.data(), mean.data() + 3);
    }
  }
  return columns;
}

std::vector<double> BoneSpace::products(std::span<const Vec3d> trajectory) const {
  return matrix_product(values_of(trajectory), 3 * t_.num_frames(), columns_, width_);
}

std::size_t BoneSpace::Part::place(std::size_t bone) const {
  const auto at =
      std::lower_bound(blocks.begin(), blocks.end(), static_cast<std::uint32_t>(bone));
  return 3 * static_cast<std::size_t>(at - blocks.begin());
}

BoneSpace::Part BoneSpace::part(std::vector<std::uint32_t> bones) const {
  Part part;
  part.bones = std::move(bones);
  std::vector<std::uint32_t> origins;
  for (const std::uint32_t b : part.bones) {
    for (const std::uint32_t g : path_[b]) insert(part.blocks, g);
    insert(origins, static_cast<std::uint32_t>(origin(b)));
  }
  for (const std::uint32_t g : part.blocks) {
    for (std::size_t c = 0; c < 3; ++c) part.coordinates.push_back(block(g) + c);
  }
  part.coordinates.insert(part.coordinates.end(), origins.begin(), origins.end());
  const std::size_t size = part.size();
  part.gram.resize(size * size);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      part.gram[i * size + j] = gram_[part.coordinates[i] * width_ + part.coordinates[j]];
    }
  }
  return part;
}

}  // namespace rlpc
