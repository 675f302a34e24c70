#include "encoder/codec/kinds/skinned/fit/skin_sums.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/math/matrix_products.h"
#include "encoder/codec/math/small_system.h"

namespace rlpc {
namespace {

constexpr std::size_t kColumns = 4;  // fixed: columns of a motion

// Returns the motions of some bones, interleaved: [frame][3][bone][4].
std::vector<double> motions_by_frame(std::span<const std::vector<Motion>> motions) {
  const std::size_t columns = kColumns * motions.size();
  const std::size_t num_frames = motions.front().size();
  std::vector<double> by_frame(3 * num_frames * columns);
  for (std::size_t b = 0; b < motions.size(); ++b) {
    for (std::size_t f = 0; f < num_frames; ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < kColumns; ++k) {
          by_frame[(3 * f + c) * columns + kColumns * b + k] =
              motions[b][f](static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k));
        }
      }
    }
  }
  return by_frame;
}

// Returns the 4 x 4 block of two bones in a matrix of `width` columns.
Eigen::Matrix4d block_at(std::span<const double> matrix, std::size_t width, std::size_t row,
                         std::size_t column) {
  Eigen::Matrix4d block;
  for (std::size_t i = 0; i < kColumns; ++i) {
    for (std::size_t k = 0; k < kColumns; ++k) {
      block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          matrix[(kColumns * row + i) * width + kColumns * column + k];
    }
  }
  return block;
}

// Appends the columns of a bone to each row of a matrix of `width` columns, in place.
void append_columns(std::vector<double>& matrix, std::size_t width,
                    std::span<const double> added) {
  const std::size_t wider = width + kColumns;
  matrix.resize(matrix.size() + added.size());
  for (std::size_t r = added.size() / kColumns; r-- > 0;) {
    const auto from = matrix.begin() + static_cast<std::ptrdiff_t>(r * width);
    const auto to = matrix.begin() + static_cast<std::ptrdiff_t>(r * wider + width);
    std::copy_backward(from, from + static_cast<std::ptrdiff_t>(width), to);
    std::copy_n(added.begin() + static_cast<std::ptrdiff_t>(r * kColumns), kColumns, to);
  }
}

// Removes the columns of a bone, in place.
void erase_columns(std::vector<double>& matrix, std::size_t width, std::size_t bone) {
  const auto at = static_cast<std::ptrdiff_t>(kColumns * bone);
  auto to = matrix.begin();
  for (auto row = matrix.begin(); row != matrix.end();) {
    const auto end = row + static_cast<std::ptrdiff_t>(width);
    to = std::copy(row, row + at, to);
    to = std::copy(row + at + kColumns, end, to);
    row = end;
  }
  matrix.erase(to, matrix.end());
}

}  // namespace

SkinSums::SkinSums(std::span<const Vec3d> positions, const BoneMotions& motions)
    : num_frames_(motions.front().size()) {
  set_positions(positions);
  set_motions(motions);
}

void SkinSums::set_positions(std::span<const Vec3d> positions) {
  static_assert(sizeof(Vec3d) == 3 * sizeof(double));
  positions_ = {};
  if (!positions.empty()) positions_ = {positions.front().data(), 3 * positions.size()};
  square_.clear();
  for (std::size_t i = 0; i < positions.size(); i += num_frames_) {
    double square = 0.0;
    for (const Vec3d& x : positions.subspan(i, num_frames_)) square += x.squaredNorm();
    square_.push_back(square);
  }
  sum_along();
}

void SkinSums::sum_along() {
  const std::size_t columns = kColumns * num_bones_;
  along_.assign(square_.size() * columns, 0.0);
  add_matrix_product(positions_, 3 * num_frames_, by_frame_, columns, along_);
}

void SkinSums::set_motions(const BoneMotions& motions) {
  sum_products(motions);
  sum_along();
}

void SkinSums::set_motions(const BoneMotions& motions,
                           std::span<const std::vector<std::size_t>> bones) {
  constexpr std::size_t kTogether = 64;  // fixed: vertices of a pass
  sum_products(motions);
  const std::size_t columns = kColumns * num_bones_;
  const std::size_t values = 3 * num_frames_;
  along_.resize(square_.size() * columns);
  for_ranges(square_.size(), kTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) {
      for (const std::size_t bone : bones[v]) {
        const std::size_t column = kColumns * bone;
        four_columns_product(
            positions_.subspan(v * values, values), by_frame_, columns, column,
            std::span<double, kColumns>(&along_[v * columns + column], kColumns));
      }
    }
  });
}

void SkinSums::sum_products(const BoneMotions& motions) {
  num_bones_ = motions.size();
  const std::size_t columns = kColumns * num_bones_;
  by_frame_ = motions_by_frame(motions);
  const std::vector<double> gram = gram_matrix(by_frame_, columns);
  product_.resize(num_bones_ * num_bones_);
  for (std::size_t a = 0; a < num_bones_; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const Eigen::Matrix4d sum = block_at(gram, columns, a, b);
      product_[a * num_bones_ + b] = sum;
      product_[b * num_bones_ + a] = sum.transpose();
    }
    product_[a * num_bones_ + a] =
        block_at(gram, columns, a, a).selfadjointView<Eigen::Lower>();
  }
}

void SkinSums::add_bone(const std::vector<Motion>& motion) {
  const std::size_t width = kColumns * num_bones_;
  const std::vector<double> added = motions_by_frame(std::span(&motion, 1));
  append_columns(along_, width, matrix_product(positions_, 3 * num_frames_, added, kColumns));
  append_columns(by_frame_, width, added);
  const std::size_t rows = 3 * num_frames_;
  std::vector<double> across(added.size());
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t k = 0; k < kColumns; ++k) across[k * rows + r] = added[r * kColumns + k];
  }
  const std::size_t before = num_bones_++;
  const std::vector<double> gram =
      matrix_product(across, rows, by_frame_, kColumns * num_bones_);
  std::vector<Eigen::Matrix4d> product(num_bones_ * num_bones_);
  for (std::size_t a = 0; a < before; ++a) {
    for (std::size_t b = 0; b < before; ++b) {
      product[a * num_bones_ + b] = product_[a * before + b];
    }
  }
  for (std::size_t b = 0; b < num_bones_; ++b) {
    const Eigen::Matrix4d sum = block_at(gram, kColumns * num_bones_, 0, b);
    product[before * num_bones_ + b] = sum;
    product[b * num_bones_ + before] = sum.transpose();
  }
  product_ = std::move(product);
}

void SkinSums::remove_bone(std::size_t bone) {
  const std::size_t width = kColumns * num_bones_;
  erase_columns(along_, width, bone);
  erase_columns(by_frame_, width, bone);
  auto to = product_.begin();
  for (std::size_t i = 0; i < product_.size(); ++i) {
    if (i / num_bones_ != bone && i % num_bones_ != bone) *to++ = product_[i];
  }
  product_.erase(to, product_.end());
  --num_bones_;
}

double SkinSums::rigid_error(std::size_t vertex, std::size_t bone, const Vec3d& rest) const {
  const Eigen::Vector4d p = homogeneous(rest);
  const double error = p.dot(product(bone, bone) * p) - 2.0 * p.dot(along(vertex, bone));
  return std::max(error + square_[vertex], 0.0);  // negative only by rounding
}

Vec3d SkinSums::single_rest(std::size_t vertex) const {
  const auto n = static_cast<double>(num_frames_);
  Vec3d best = Vec3d::Zero();
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t b = 0; b < num_bones_; ++b) {
    // Sums over the frames of R^T (x - t), the rest position that fits the frame, and its
    // square.
    const Eigen::Vector4d sums = along(vertex, b);
    const Eigen::Matrix4d& own = product(b, b);
    const Vec3d rest = sums.head<3>() - own.block<3, 1>(0, 3);
    const double square = square_[vertex] - 2.0 * sums(3) + own(3, 3);
    const double error = square - rest.squaredNorm() / n;
    if (error >= min) continue;
    min = error;
    best = rest / n;
  }
  return best;
}

std::vector<std::size_t> SkinSums::closest_bones(std::size_t vertex, const Vec3d& rest,
                                                 std::size_t count) const {
  std::vector<std::pair<double, std::size_t>> order;
  order.reserve(num_bones_);
  for (std::size_t b = 0; b < num_bones_; ++b) {
    order.emplace_back(rigid_error(vertex, b, rest), b);
  }
  count = std::min(order.size(), count);
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
                    order.end());
  order.resize(count);
  std::vector<std::size_t> bones;
  bones.reserve(order.size());
  for (const auto& [error, bone] : order) bones.push_back(bone);
  return bones;
}

SkinSums::Gram SkinSums::gram(std::size_t vertex, std::span<const std::size_t> bones,
                              const Vec3d& rest) const {
  assert(bones.size() <= kMaxCandidates);
  const Eigen::Vector4d p = homogeneous(rest);
  std::array<double, kMaxCandidates> part{};
  for (std::size_t i = 0; i < bones.size(); ++i) part[i] = p.dot(along(vertex, bones[i]));
  Gram gram{};
  for (std::size_t i = 0; i < bones.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const double both = p.dot(product(bones[i], bones[j]) * p);
      const double value = both - part[i] - part[j] + square_[vertex];
      gram[i * kMaxCandidates + j] = gram[j * kMaxCandidates + i] = value;
    }
  }
  for (std::size_t i = 0; i < bones.size(); ++i) {
    double& own = gram[i * kMaxCandidates + i];
    own = std::max(own, 0.0);  // negative only by rounding
  }
  return gram;
}

Vec3d SkinSums::fit_rest(std::size_t vertex, const Vec3d& before,
                         std::span<const RigWeight> weights) const {
  constexpr double kPull = 1e-4;  // fixed: where frames leave a choice
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  Eigen::Vector4d wanted = Eigen::Vector4d::Zero();
  for (const RigWeight& a : weights) {
    wanted += a.weight * along(vertex, a.bone);
    for (const RigWeight& b : weights) sum += a.weight * b.weight * product(a.bone, b.bone);
  }
  const double pull = kPull * static_cast<double>(num_frames_);
  SmallSystem<3> m;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < 3; ++k) m.a[i][k] = sum(row, static_cast<Eigen::Index>(k));
    m.a[i][i] += pull;
    m.b[i] = wanted(row) - sum(row, 3) + pull * before(row);
  }
  const auto rest = solve_small(m);
  return rest.is_unique ? Vec3d(rest.x[0], rest.x[1], rest.x[2]) : before;
}

}  // namespace rlpc
