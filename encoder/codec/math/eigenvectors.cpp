#include "encoder/codec/math/eigenvectors.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/inverse_iteration.h"
#include "encoder/codec/math/matrix_products.h"

namespace rlpc {
namespace {

using Square = Eigen::MatrixXd;

// From this width on, subspace iteration is faster if at most 1 / kFewPart of the vectors are
// wanted.
constexpr std::size_t kWide = 600;
constexpr std::size_t kFewPart = 4;

// Fixes Eigen's blocking, and so the order of its sums, which depends on the cache sizes. Runs
// once, as several threads read them.
void fix_eigen_blocking() {
  [[maybe_unused]] static const bool kIsFixed = [] {
    Eigen::setCpuCacheSizes(32 << 10, 512 << 10, 4 << 20);
    return true;
  }();
}

// Fixes the arbitrary sign of an eigenvector: makes its largest element positive.
void fix_sign(std::vector<double>& v) {
  double largest = 0.0;
  for (const double x : v) {
    if (std::abs(x) > std::abs(largest)) largest = x;
  }
  if (largest < 0.0) {
    for (double& x : v) x = -x;
  }
}

Square square_of(std::span<const double> lower, std::size_t width) {
  const auto n = static_cast<Eigen::Index>(width);
  Square square(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j)
      square(i, j) = lower[static_cast<std::size_t>(i * n + j)];
  }
  return square;
}

// Returns the last `count` columns of a matrix, from the last backwards.
std::vector<std::vector<double>> last_columns(const Square& from, std::size_t count) {
  std::vector<std::vector<double>> vectors;
  for (Eigen::Index l = from.cols(); vectors.size() < count; --l) {
    const auto column = from.col(l - 1);
    fix_sign(vectors.emplace_back(column.begin(), column.end()));
  }
  return vectors;
}

std::vector<double> descending_values(const Eigen::SelfAdjointEigenSolver<Square>& solver) {
  const auto& ascending = solver.eigenvalues();
  std::vector<double> values;
  for (Eigen::Index l = ascending.size(); l-- > 0;) {
    values.push_back(std::max(ascending(l), 0.0));
  }
  return values;
}

std::size_t num_wanted(const std::vector<double>& values, std::size_t max_count, double min) {
  std::size_t wanted = 0;
  while (wanted < std::min(values.size(), max_count) && values[wanted] > min) ++wanted;
  return wanted;
}

EigenPairs all_eigenvectors(std::span<const double> matrix, std::size_t width,
                            std::size_t max_count, double min) {
  fix_eigen_blocking();
  const Eigen::SelfAdjointEigenSolver<Square> solver(square_of(matrix, width));
  EigenPairs pairs{descending_values(solver), {}};
  pairs.vectors = last_columns(solver.eigenvectors(), num_wanted(pairs.values, max_count, min));
  return pairs;
}

// Computes all values, and vectors one at a time: faster unless almost all vectors are wanted.
// None if they are, or if inverse iteration fails.
std::optional<EigenPairs> single_eigenvectors(std::span<const double> matrix, std::size_t width,
                                              std::size_t max_count, double min) {
  fix_eigen_blocking();
  const Eigen::Tridiagonalization<Square> reduced(square_of(matrix, width));
  const Eigen::VectorXd diagonal = reduced.diagonal();
  const Eigen::VectorXd subdiagonal = reduced.subDiagonal();
  Eigen::SelfAdjointEigenSolver<Square> solver;
  solver.computeFromTridiagonal(diagonal, subdiagonal, Eigen::EigenvaluesOnly);
  EigenPairs pairs{descending_values(solver), {}};
  const std::size_t wanted = num_wanted(pairs.values, max_count, min);
  if (wanted >= width) return std::nullopt;
  if (wanted == 0) return pairs;
  const auto vectors =
      tridiagonal_eigenvectors({diagonal.data(), width}, {subdiagonal.data(), width - 1},
                               std::span(pairs.values).first(wanted));
  if (!vectors) return std::nullopt;
  Square columns(diagonal.size(), static_cast<Eigen::Index>(wanted));
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    columns.col(columns.cols() - 1 - k) = Eigen::Map<const Eigen::VectorXd>(
        (*vectors)[static_cast<std::size_t>(k)].data(), diagonal.size());
  }
  constexpr std::size_t kTogether = 32;  // columns of a pass
  for_ranges(wanted, kTogether, [&](std::size_t first, std::size_t end) {
    columns.middleCols(static_cast<Eigen::Index>(first), static_cast<Eigen::Index>(end - first))
        .applyOnTheLeft(reduced.matrixQ());
  });
  pairs.vectors = last_columns(columns, wanted);
  return pairs;
}

// Subspace iteration (Rutishauser 1970): repeatedly multiplies a block of vectors by the matrix
// and orthonormalises it, until it spans the eigenvectors of the largest values.
class SubspaceIteration {
 public:
  SubspaceIteration(const std::vector<double>& lower, std::size_t width)
      : width_(width), matrix_(lower) {
    for (std::size_t i = 0; i < width; ++i) {
      for (std::size_t j = 0; j < i; ++j) matrix_[j * width + i] = matrix_[i * width + j];
    }
  }

  // Finds the vectors; none if too many are wanted for this method.
  std::optional<EigenPairs> find(std::size_t max_count, double min) {
    constexpr std::size_t kFirstCount = 16;
    constexpr double kMargin = 0.5;  // part of `min`; the block grows until a value is below
    constexpr std::size_t kMoreCount = 8;
    constexpr std::size_t kTelling = 32;  // fewest values to extrapolate from
    const std::size_t max = width_ / kFewPart;
    for (std::size_t count = kFirstCount; count <= max; count *= 2) {
      widen(count);
      for (int i = 0; i < kRounds; ++i) multiply();
      EigenPairs pairs = rotate();
      if (pairs.values.back() < kMargin * min || count >= max_count + kMoreCount) {
        pairs.vectors.resize(num_wanted(pairs.values, max_count, min));
        for (auto& v : pairs.vectors) fix_sign(v);
        return pairs;
      }
      if (count >= kTelling && min > 0.0 &&
          at_this_rate(pairs.values, min) > static_cast<double>(max)) {
        break;
      }
    }
    return std::nullopt;
  }

 private:
  static constexpr int kRounds = 6;

  // Extrapolates the number of values above `min` from how fast the second half of the values
  // falls: between an exponential fall and a power law.
  static double at_this_rate(const std::vector<double>& values, double min) {
    const std::size_t half = values.size() / 2;
    const double fall = det_log2(values[half] / values.back());
    const double left = det_log2(values.back() / min);
    const auto count = static_cast<double>(values.size());
    const double exponential = count + static_cast<double>(half) * left / fall;
    const double power = count * det_exp2(std::min(left / fall, 40.0));
    return std::sqrt(std::max(exponential, 1.0) * power);
  }

  // Appends pseudo-random vectors.
  void widen(std::size_t count) {
    while (block_.size() < count) {
      std::vector<double>& v = block_.emplace_back(width_);
      for (double& x : v) {
        random_ = random_ * 6364136223846793005U + 1442695040888963407U;
        x = static_cast<double>(random_ >> 40) * 0x1p-24 - 0.5;
      }
    }
  }

  // Multiplies by the matrix and orthonormalises: Gram-Schmidt, twice because of rounding.
  // Linearly dependent vectors become 0.
  void multiply() {
    block_ = project(matrix_, width_, block_);
    for (std::size_t k = 0; k < block_.size(); ++k) {
      std::vector<double>& v = block_[k];
      const double before = dot(v, v);
      for (int again = 0; again < 2; ++again) {
        for (std::size_t j = 0; j < k; ++j) add(v, -dot(v, block_[j]), block_[j]);
      }
      constexpr double kRounding = 1e-24;
      const double square = dot(v, v);
      const double scale =
          square > kRounding * before && square > 0.0 ? 1.0 / std::sqrt(square) : 0.0;
      for (double& x : v) x *= scale;
    }
  }

  // Rotates the vectors within their span to approximate eigenvectors (Rayleigh-Ritz).
  EigenPairs rotate() {
    const std::size_t count = block_.size();
    const std::vector<std::vector<double>> products = project(matrix_, width_, block_);
    std::vector<double> small(count * count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j <= i; ++j) small[i * count + j] = dot(block_[i], products[j]);
    }
    EigenPairs within = all_eigenvectors(small, count, count, -1.0);
    EigenPairs pairs{std::move(within.values), {}};
    for (const auto& mixing : within.vectors) {
      std::vector<double>& v = pairs.vectors.emplace_back(width_);
      for (std::size_t k = 0; k < count; ++k) add(v, mixing[k], block_[k]);
    }
    block_ = pairs.vectors;
    return pairs;
  }

  // Four partial sums, to shorten the dependency chain of additions.
  static double dot(const std::vector<double>& a, const std::vector<double>& b) {
    std::array<double, 4> sum{};
    std::size_t i = 0;
    for (; i + 4 <= a.size(); i += 4) {
      for (std::size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
    }
    for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
  static void add(std::vector<double>& to, double factor, const std::vector<double>& v) {
    for (std::size_t i = 0; i < v.size(); ++i) to[i] += factor * v[i];
  }

  std::size_t width_;
  std::vector<double> matrix_;
  std::vector<std::vector<double>> block_;  // orthonormal after multiply()
  std::uint64_t random_ = 1;
};

}  // namespace

EigenPairs leading_eigenvectors(const std::vector<double>& matrix, std::size_t width,
                                std::size_t max_count, double min) {
  if (width >= kWide) {
    if (auto few = SubspaceIteration(matrix, width).find(max_count, min)) {
      return std::move(*few);
    }
  }
  if (auto single = single_eigenvectors(matrix, width, max_count, min)) {
    return std::move(*single);
  }
  return all_eigenvectors(matrix, width, max_count, min);
}

}  // namespace rlpc
