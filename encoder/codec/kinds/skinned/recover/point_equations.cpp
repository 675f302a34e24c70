#include "encoder/codec/kinds/skinned/recover/point_equations.h"

#include <utility>

#include "encoder/codec/kinds/skinned/recover/skin_vertex.h"
#include "encoder/codec/math/matrix_products.h"
#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

Eigen::Matrix3d cross_matrix(const Vec3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a(2), a(1), a(2), 0.0, -a(0), -a(1), a(0), 0.0;
  return m;
}

// Makes the equations of a point, from which its rest position, and its weights if they vary,
// are eliminated.
class PointEquations {
 public:
  PointEquations(const PlacedBones& bones, const FollowingPoint& point)
      : bones_(bones), point_(point), size_(point.part.size()) {}

  StepEquations make() {
    find_sums();
    add_bones();
    add_point();
    std::vector<double> moved(size_, 0.0);
    for (const RigWeight& w : point_.weights) {
      bones_.add_moved(point_.part, w.bone, point_.rest, w.weight, moved);
    }
    const std::vector<double> gx = times(point_.part.gram, moved);
    std::vector<double> left(size_);
    for (std::size_t s = 0; s < size_; ++s) {
      left[s] = (point_.wanted.empty() ? 0.0 : point_.wanted[s]) - gx[s];
    }
    return eliminated(left);
  }

 private:
  // For each bone on the paths of those that the point follows, finds the sum of the weights
  // that pass through it, the sum of weights times the pivot that comes next, and the weights
  // that pass to each bone after it.
  void find_sums() {
    const BoneSpace& space = bones_.space();
    const std::size_t blocks = point_.part.blocks.size();
    passing_.assign(blocks, 0.0);
    next_.assign(blocks, Vec3d::Zero());
    handed_.assign(blocks * blocks, 0.0);
    column_.assign(blocks, kUnused);
    for (const RigWeight& w : point_.weights) {
      const std::vector<std::uint32_t>& path = space.path(w.bone);
      for (std::size_t k = 0; k < path.size(); ++k) {
        const std::size_t g = point_.part.place(path[k]) / 3;
        passing_[g] += w.weight;
        column_[g] = 0;
        if (k + 1 == path.size()) {
          next_[g] += w.weight * point_.rest;
        } else {
          next_[g] += w.weight * bones_.pivot(path[k + 1]);
          handed_[g * blocks + point_.part.place(path[k + 1]) / 3] += w.weight;
        }
      }
    }
    for (std::size_t g = 0; g < blocks; ++g) {
      if (column_[g] == kUnused) continue;
      column_[g] = equations_.unknowns.size();
      const std::uint32_t bone = point_.part.blocks[g];
      for (std::size_t j = 0; j < PlacedBones::kUnknowns; ++j) {
        equations_.unknowns.push_back(bone * PlacedBones::kUnknowns + j);
      }
    }
  }

  // Adds the derivatives of the coordinates with respect to turns and pivots.
  void add_bones() {
    const std::size_t blocks = point_.part.blocks.size();
    const std::size_t count = equations_.unknowns.size();
    by_bones_.assign(size_ * count, 0.0);
    for (std::size_t g = 0; g < blocks; ++g) {
      if (column_[g] == kUnused) continue;
      const std::uint32_t bone = point_.part.blocks[g];
      const Eigen::Matrix3d& turn = bones_.turn(bone);
      const Vec3d lever = next_[g] - passing_[g] * bones_.pivot(bone);
      add_block(-turn * cross_matrix(lever), 3 * g, column_[g], count, by_bones_);
      add_block(-passing_[g] * turn, 3 * g, column_[g] + 3, count, by_bones_);
      for (std::size_t e = 0; e < blocks; ++e) {
        const double weight = handed_[g * blocks + e];
        if (weight == 0.0) continue;
        add_block(weight * turn, 3 * g, column_[e] + 3, count, by_bones_);
      }
    }
  }

  // Adds those with respect to the rest position and all weights but the last.
  void add_point() {
    const std::size_t others = point_.weights_vary ? point_.weights.size() - 1 : 0;
    own_ = 3 + others;
    by_point_.assign(size_ * own_, 0.0);
    std::vector<double> last(size_, 0.0);
    bones_.add_moved(point_.part, point_.weights.back().bone, point_.rest, 1.0, last);
    for (std::size_t k = 0; k < point_.weights.size(); ++k) {
      const RigWeight& w = point_.weights[k];
      add_block(w.weight * bones_.turn(w.bone), point_.part.place(w.bone), 0, own_, by_point_);
      if (k >= others) continue;
      std::vector<double> one(size_, 0.0);
      bones_.add_moved(point_.part, w.bone, point_.rest, 1.0, one);
      for (std::size_t s = 0; s < size_; ++s) by_point_[s * own_ + 3 + k] = one[s] - last[s];
    }
  }

  // left: products of what is left with the coordinates
  StepEquations eliminated(const std::vector<double>& left) {
    constexpr double kRegular = 1e-9;  // fixed: directions that frames leave open
    const std::size_t count = equations_.unknowns.size();
    NormalEquations bones = normal_equations(point_.part.gram, by_bones_, left, count);
    NormalEquations own = normal_equations(point_.part.gram, by_point_, left, own_);
    const std::vector<double> along = matrix_product(point_.part.gram, size_, by_bones_, count);
    std::vector<double> both(own_ * count, 0.0);
    for (std::size_t s = 0; s < size_; ++s) {
      for (std::size_t k = 0; k < own_; ++k) {
        subtract_multiple(-by_point_[s * own_ + k], std::span(along).subspan(s * count, count),
                          std::span(both).subspan(k * count, count));
      }
    }
    for (std::size_t k = 0; k < own_; ++k) {
      own.a[k * own_ + k] =
          own.a[k * own_ + k] * (1.0 + kRegular) + (point_.weights_vary ? 0.0 : kRegular);
    }
    const SymmetricSystem system(std::move(own.a), own_);
    std::vector<double> through = both;
    system.solve(through, count);
    system.solve(own.b);
    for (std::size_t k = 0; k < own_; ++k) {
      const std::span<const double> row = std::span(through).subspan(k * count, count);
      for (std::size_t p = 0; p < count; ++p) {
        const double value = both[k * count + p];
        bones.b[p] -= value * own.b[k];
        subtract_multiple(value, row, std::span(bones.a).subspan(p * count, count));
      }
    }
    equations_.a = std::move(bones.a);
    equations_.b = std::move(bones.b);
    return std::move(equations_);
  }

  static constexpr std::size_t kUnused = ~std::size_t{0};  // fixed: no column

  const PlacedBones& bones_;
  const FollowingPoint& point_;
  std::size_t size_;                 // coordinates of the part
  std::vector<double> passing_;      // [block]
  std::vector<Vec3d> next_;          // [block]
  std::vector<double> handed_;       // [block][block after it]
  std::vector<std::size_t> column_;  // [block], its first unknown; kUnused: not on a path
  std::vector<double> by_bones_;     // [size][unknown]
  std::size_t own_ = 0;
  std::vector<double> by_point_;  // [size][own unknown]
  StepEquations equations_;
};

}  // namespace

StepEquations point_equations(const PlacedBones& bones, const FollowingPoint& point) {
  return PointEquations(bones, point).make();
}

}  // namespace rlpc
