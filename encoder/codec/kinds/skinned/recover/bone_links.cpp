#include "encoder/codec/kinds/skinned/recover/bone_links.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

std::vector<std::size_t> blocks_of(const BoneSpace& space, std::span<const std::size_t> bones) {
  std::vector<std::size_t> coordinates;
  for (const std::size_t b : bones) {
    for (std::size_t c = 0; c < 3; ++c) coordinates.push_back(space.block(b) + c);
  }
  return coordinates;
}

}  // namespace

BoneLinks::BoneLinks(const Trajectories& trajectories, const BoneChains& chains,
                     const BoneSpace& space)
    : chains_(chains),
      space_(space),
      num_bones_(space.num_bones()),
      num_values_(3 * trajectories.num_frames()),
      links_(num_bones_ * num_bones_) {
  constexpr std::size_t kSome = 3000;  // fixed: time and memory
  std::vector<std::uint32_t> several;
  for (std::uint32_t v = 0; v < trajectories.num_vertices(); ++v) {
    if (chains.candidates[v].size() > 1) several.push_back(v);
  }
  vertices_.resize(std::min(several.size(), kSome));
  for_each(vertices_.size(), [&](std::size_t i) {
    Vertex& v = vertices_[i];
    v.number = several[i * several.size() / vertices_.size()];
    const std::vector<Vec3d> trajectory = trajectories.of(v.number);
    v.products = space.products(trajectory);
    for (const Vec3d& x : trajectory) v.square += x.squaredNorm();
  });
}

// Returns the RMS of a coordinate of what the best motion along some coordinates leaves of a
// trajectory.
//
//   point  coordinates of the point that it is seen from
double BoneLinks::left_of(const Vertex& v, std::span<const double> point,
                          const std::vector<std::size_t>& along) const {
  constexpr double kRegular = 1e-11;  // fixed: rounding
  const std::size_t count = along.size();
  const auto product = [&](std::size_t c) {  // of the point
    double sum = 0.0;
    for (std::size_t i = 0; i < point.size(); ++i) {
      if (point[i] != 0.0) sum += point[i] * space_.gram(i, c);
    }
    return sum;
  };
  double square = v.square;
  for (std::size_t i = 0; i < point.size(); ++i) {
    if (point[i] != 0.0) square += point[i] * (product(i) - 2.0 * v.products[i]);
  }
  std::vector<double> a(count * count);
  std::vector<double> b(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) a[i * count + j] = space_.gram(along[i], along[j]);
    a[i * count + i] *= 1.0 + kRegular;
    b[i] = v.products[along[i]] - product(along[i]);
  }
  std::vector<double> x = b;
  SymmetricSystem(std::move(a), count).solve(x);
  for (std::size_t i = 0; i < count; ++i) square -= x[i] * b[i];
  return std::sqrt(std::max(square, 0.0) / static_cast<double>(num_values_));
}

void BoneLinks::add(const PlacedBones& bones, std::size_t bone) {
  constexpr double kFollows = 1e-5;  // fixed: extents; above rounding
  constexpr double kNot = 1e-4;      // fixed: extents; a tenth of the error at KG 0.1 %
  const auto a = static_cast<std::uint32_t>(bone);
  std::vector<std::vector<std::uint32_t>> others(vertices_.size());
  for_each(vertices_.size(), [&](std::size_t i) {
    const Vertex& v = vertices_[i];
    const auto& candidates = chains_.candidates[v.number];
    if (!std::binary_search(candidates.begin(), candidates.end(), a)) return;
    const std::span<const double> pivot = bones.coordinates_of_pivot(bone);
    if (left_of(v, pivot, blocks_of(space_, std::array{bone})) < kNot) return;
    for (const std::uint32_t other : candidates) {
      const std::size_t b = other;
      if (b == bone ||
          !(left_of(v, pivot, blocks_of(space_, std::array{bone, b})) < kFollows)) {
        continue;
      }
      const bool is_alone =
          space_.has_place(b) &&
          left_of(v, bones.coordinates_of_pivot(b), blocks_of(space_, std::array{b})) < kNot;
      if (!is_alone) others[i].push_back(other);
    }
  });
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    for (const std::uint32_t b : others[i]) {
      links_[bone * num_bones_ + b].push_back(vertices_[i].number);
    }
  }
}

}  // namespace rlpc
