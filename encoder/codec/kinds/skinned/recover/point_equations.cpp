#include "encoder/codec/kinds/skinned/recover/point_equations.h"

#include <cstddef>
#include <utility>

#include "encoder/codec/kinds/skinned/recover/skin_vertex.h"
#include "encoder/codec/math/matrix_products.h"
#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

// Makes the equations of a point, from which its rest position, and its weights if they vary,
// are eliminated.
class PointEquations {
 public:
  PointEquations(const PlacedBones& bones, const FollowingPoint& point)
      : bones_(bones), point_(point), size_(point.part.size()) {}

  StepEquations make() {
    find_sums();
    const std::vector<double> by_point = point_derivatives(bones_, point_.part, point_.weights,
                                                           point_.rest, point_.weights_vary);
    const std::size_t own = by_point.size() / size_;
    add_bones(own);
    const std::size_t count = equations_.unknowns.size();
    for (std::size_t s = 0; s < size_; ++s) {
      for (std::size_t k = 0; k < own; ++k) {
        derivatives_[s * (count + own) + count + k] = by_point[s * own + k];
      }
    }
    std::vector<double> moved(size_, 0.0);
    for (const RigWeight& w : point_.weights) {
      bones_.add_moved(point_.part, w.bone, point_.rest, w.weight, moved);
    }
    const std::vector<double> gx = times(point_.part.gram, moved);
    std::vector<double> left(size_);
    for (std::size_t s = 0; s < size_; ++s) {
      left[s] = (point_.wanted.empty() ? 0.0 : point_.wanted[s]) - gx[s];
    }
    return eliminated(own, left);
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

  // Adds the derivatives of the coordinates with respect to turns and pivots, and leaves room
  // for those with respect to unknowns of the point.
  void add_bones(std::size_t own) {
    const std::size_t blocks = point_.part.blocks.size();
    const std::size_t width = equations_.unknowns.size() + own;
    derivatives_.assign(size_ * width, 0.0);
    for (std::size_t g = 0; g < blocks; ++g) {
      if (column_[g] == kUnused) continue;
      const std::uint32_t bone = point_.part.blocks[g];
      const Eigen::Matrix3d& turn = bones_.turn(bone);
      const Vec3d lever = next_[g] - passing_[g] * bones_.pivot(bone);
      add_block(-turn * cross_matrix(lever), 3 * g, column_[g], width, derivatives_);
      add_block(-passing_[g] * turn, 3 * g, column_[g] + 3, width, derivatives_);
      for (std::size_t e = 0; e < blocks; ++e) {
        const double weight = handed_[g * blocks + e];
        if (weight == 0.0) continue;
        add_block(weight * turn, 3 * g, column_[e] + 3, width, derivatives_);
      }
    }
  }

  // Eliminates the last unknowns, those of the point.
  //
  //   own   their number
  //   left  products of what is left with the coordinates
  StepEquations eliminated(std::size_t own, const std::vector<double>& left) {
    constexpr double kRegular = 1e-9;  // fixed: directions that frames leave open
    const std::size_t count = equations_.unknowns.size();
    const std::size_t all = count + own;
    const NormalEquations e = normal_equations(point_.part.gram, derivatives_, left, all);
    std::vector<double> own_a;
    std::vector<double> own_b(e.b.begin() + static_cast<std::ptrdiff_t>(count), e.b.end());
    std::vector<double> both;  // [own][count]
    for (std::size_t k = count; k < all; ++k) {
      const auto row = e.a.begin() + static_cast<std::ptrdiff_t>(k * all);
      both.insert(both.end(), row, row + static_cast<std::ptrdiff_t>(count));
      own_a.insert(own_a.end(), row + static_cast<std::ptrdiff_t>(count),
                   row + static_cast<std::ptrdiff_t>(all));
    }
    for (std::size_t k = 0; k < own; ++k) {
      double& diagonal = own_a[k * own + k];
      diagonal = diagonal * (1.0 + kRegular) + (point_.weights_vary ? 0.0 : kRegular);
    }
    const SymmetricSystem system(std::move(own_a), own);
    std::vector<double> through = both;
    system.solve(through, count);
    system.solve(own_b);
    for (std::size_t p = 0; p < count; ++p) {
      const auto row = e.a.begin() + static_cast<std::ptrdiff_t>(p * all);
      equations_.a.insert(equations_.a.end(), row, row + static_cast<std::ptrdiff_t>(count));
      equations_.b.push_back(e.b[p]);
    }
    for (std::size_t k = 0; k < own; ++k) {
      const std::span<const double> row = std::span(through).subspan(k * count, count);
      for (std::size_t p = 0; p < count; ++p) {
        const double value = both[k * count + p];
        equations_.b[p] -= value * own_b[k];
        subtract_multiple(value, row, std::span(equations_.a).subspan(p * count, count));
      }
    }
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
  std::vector<double> derivatives_;  // [size][unknown], those of the point last
  StepEquations equations_;
};

}  // namespace

StepEquations point_equations(const PlacedBones& bones, const FollowingPoint& point) {
  return PointEquations(bones, point).make();
}

}  // namespace rlpc
