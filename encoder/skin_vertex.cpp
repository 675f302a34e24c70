#include "encoder/skin_vertex.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

#include "encoder/symmetric_solve.h"

namespace rlpc {
namespace {

Eigen::Vector4d homogeneous(const Vec3d& p) { return {p(0), p(1), p(2), 1.0}; }

}  // namespace

MotionProducts::MotionProducts(const BoneMotions& motions)
    : num_bones_(motions.size()), product_(num_bones_ * num_bones_, Eigen::Matrix4d::Zero()) {
  for (std::size_t a = 0; a < num_bones_; ++a) {
    for (std::size_t b = 0; b <= a; ++b) {
      Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
      for (std::size_t f = 0; f < motions[a].size(); ++f) {
        sum += motions[a][f].transpose() * motions[b][f];
      }
      product_[a * num_bones_ + b] = sum;
      product_[b * num_bones_ + a] = sum.transpose();
    }
  }
}

SkinVertex::SkinVertex(std::span<const Vec3d> positions, const BoneMotions& motions,
                       std::span<const std::size_t> candidates)
    : size_(candidates.size()), num_frames_(positions.size()) {
  assert(size_ <= kMaxCandidates);
  for (const Vec3d& x : positions) square_ += x.squaredNorm();
  for (std::size_t i = 0; i < size_; ++i) {
    bone_[i] = candidates[i];
    const std::vector<Motion>& motion = motions[candidates[i]];
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::size_t f = 0; f < num_frames_; ++f) sum += motion[f].transpose() * positions[f];
    sum_[i] = sum;
  }
}

SkinVertex::Gram SkinVertex::gram(const MotionProducts& products, const Vec3d& rest) const {
  const Eigen::Vector4d p = homogeneous(rest);
  std::array<double, kMaxCandidates> along{};
  for (std::size_t i = 0; i < size_; ++i) along[i] = p.dot(sum_[i]);
  Gram gram{};
  for (std::size_t i = 0; i < size_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const double both = p.dot(products(bone_[i], bone_[j]) * p);
      const double value = both - along[i] - along[j] + square_;
      gram[i * kMaxCandidates + j] = gram[j * kMaxCandidates + i] = value;
    }
  }
  for (std::size_t i = 0; i < size_; ++i) {
    double& own = gram[i * kMaxCandidates + i];
    own = std::max(own, 0.0);  // but for rounding
  }
  return gram;
}

std::size_t SkinVertex::place_of(std::size_t bone) const {
  const auto at = std::find(bone_.begin(), bone_.begin() + size_, bone);
  assert(at != bone_.begin() + size_);
  return static_cast<std::size_t>(at - bone_.begin());
}

Vec3d SkinVertex::fit_rest(const MotionProducts& products, const Vec3d& before,
                           std::span<const RigWeight> weights) const {
  constexpr double kPull = 1e-4;
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  Eigen::Vector4d wanted = Eigen::Vector4d::Zero();
  for (const RigWeight& a : weights) {
    wanted += a.weight * sum_[place_of(a.bone)];
    for (const RigWeight& b : weights) sum += a.weight * b.weight * products(a.bone, b.bone);
  }
  const double pull = kPull * static_cast<double>(num_frames_);
  std::vector<double> m(9);
  std::vector<double> x(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < 3; ++k) m[i * 3 + k] = sum(row, static_cast<Eigen::Index>(k));
    m[i * 3 + i] += pull;
    x[i] = wanted(row) - sum(row, 3) + pull * before(row);
  }
  solve_symmetric(m, x);
  return {x[0], x[1], x[2]};
}

double rigid_error(std::span<const Vec3d> positions, const Vec3d& rest,
                   const std::vector<Motion>& motion) {
  double error = 0.0;
  for (std::size_t f = 0; f < positions.size(); ++f) {
    error += (moved(motion[f], rest) - positions[f]).squaredNorm();
  }
  return error;
}

Vec3d single_rest(std::span<const Vec3d> positions, const BoneMotions& motions) {
  const auto n = static_cast<double>(positions.size());
  Vec3d best = Vec3d::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<Motion>& motion : motions) {
    Vec3d sum = Vec3d::Zero();  // of where the rest position would be for each frame
    double square = 0.0;
    for (std::size_t f = 0; f < positions.size(); ++f) {
      const Vec3d rest =
          motion[f].leftCols<3>().transpose() * (positions[f] - motion[f].col(3));
      sum += rest;
      square += rest.squaredNorm();
    }
    const double error = square - sum.squaredNorm() / n;
    if (error >= least) continue;
    least = error;
    best = sum / n;
  }
  return best;
}

std::vector<std::size_t> closest_bones(std::span<const Vec3d> positions, const Vec3d& rest,
                                       const BoneMotions& motions, std::size_t count) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t b = 0; b < motions.size(); ++b) {
    order.emplace_back(rigid_error(positions, rest, motions[b]), b);
  }
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), count));
  std::vector<std::size_t> bones;
  bones.reserve(order.size());
  for (const auto& [error, bone] : order) bones.push_back(bone);
  return bones;
}

}  // namespace rlpc
