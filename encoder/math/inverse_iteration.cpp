#include "encoder/math/inverse_iteration.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "encoder/math/matrix_products.h"

namespace rlpc {
namespace {

// The LU factorisation, with row exchanges, of a tridiagonal matrix minus `shift` times the
// identity.
class ShiftedFactors {
 public:
  ShiftedFactors(std::span<const double> diagonal, std::span<const double> beside, double shift,
                 double least_pivot)
      : rows_(diagonal.size()) {
    const std::size_t n = rows_.size();
    Row row{diagonal[0] - shift, n > 1 ? beside[0] : 0.0, 0.0};
    for (std::size_t i = 0; i + 1 < n; ++i) {
      Row next{beside[i], diagonal[i + 1] - shift, i + 2 < n ? beside[i + 1] : 0.0};
      row.exchanged = std::abs(next.pivot) > std::abs(row.pivot);
      if (row.exchanged) {
        std::swap(row.pivot, next.pivot);
        std::swap(row.right, next.right);
        std::swap(row.far, next.far);
      }
      row.pivot = away_from_zero(row.pivot, least_pivot);
      row.factor = next.pivot / row.pivot;
      rows_[i] = row;
      row = Row{next.right - row.factor * row.right, next.far - row.factor * row.far, 0.0};
    }
    row.pivot = away_from_zero(row.pivot, least_pivot);
    rows_.back() = row;
  }

  void solve(std::vector<double>& x) const {
    const std::size_t n = rows_.size();
    for (std::size_t i = 0; i + 1 < n; ++i) {
      if (rows_[i].exchanged) std::swap(x[i], x[i + 1]);
      x[i + 1] -= rows_[i].factor * x[i];
    }
    for (std::size_t i = n; i-- > 0;) {
      if (i + 1 < n) x[i] -= rows_[i].right * x[i + 1];
      if (i + 2 < n) x[i] -= rows_[i].far * x[i + 2];
      x[i] /= rows_[i].pivot;
    }
  }

 private:
  struct Row {
    double pivot = 0.0;
    double right = 0.0;  // the two elements to the right of the pivot
    double far = 0.0;
    double factor = 0.0;  // multiple of this row subtracted from the next
    bool exchanged = false;
  };

  static double away_from_zero(double pivot, double least) {
    return std::abs(pivot) >= least ? pivot : std::copysign(least, pivot);
  }

  std::vector<Row> rows_;
};

// Orthonormal vectors, stored both as rows and as columns.
class Basis {
 public:
  Basis(std::size_t width, std::size_t most) : width_(width), most_(most) {
    rows_.reserve(width * most);
    columns_.resize(width * most);
  }

  // Subtracts from x its projection onto the vectors.
  void remove_projection(std::vector<double>& x) const {
    if (count_ == 0) return;
    const std::vector<double> parts = matrix_product(x, width_, columns_, most_);
    const std::vector<double> sum = matrix_product(parts, most_, rows_, width_);
    for (std::size_t i = 0; i < width_; ++i) x[i] -= sum[i];
  }
  void add(const std::vector<double>& x) {
    rows_.insert(rows_.end(), x.begin(), x.end());
    for (std::size_t i = 0; i < width_; ++i) columns_[i * most_ + count_] = x[i];
    ++count_;
  }

 private:
  std::size_t width_;
  std::size_t most_;
  std::size_t count_ = 0;
  std::vector<double> rows_;
  std::vector<double> columns_;
};

// False if the vector is zero or not finite.
bool normalise(std::vector<double>& x) {
  double largest = 0.0;
  for (const double v : x) largest = std::max(largest, std::abs(v));
  if (!(largest > 0.0) || !std::isfinite(largest)) return false;
  double square = 0.0;
  for (double& v : x) {
    v /= largest;
    square += v * v;
  }
  const double scale = 1.0 / std::sqrt(square);
  for (double& v : x) v *= scale;
  return true;
}

// The largest magnitude of an element of (matrix - value) x.
double residual(std::span<const double> diagonal, std::span<const double> beside, double value,
                const std::vector<double>& x) {
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double sum = (diagonal[i] - value) * x[i];
    if (i > 0) sum += beside[i - 1] * x[i - 1];
    if (i + 1 < x.size()) sum += beside[i] * x[i + 1];
    worst = std::max(worst, std::abs(sum));
  }
  return worst;
}

}  // namespace

std::optional<std::vector<std::vector<double>>> tridiagonal_eigenvectors(
    std::span<const double> diagonal, std::span<const double> beside,
    std::span<const double> values) {
  constexpr int kRounds = 3;
  constexpr double kConverged =
      1e-11;  // residual relative to the largest element of the matrix
  constexpr double kApart =
      8.0;  // in units of rounding: equal values are separated by this much
  const std::size_t n = diagonal.size();
  double size = 0.0;
  for (const double x : diagonal) size = std::max(size, std::abs(x));
  for (const double x : beside) size = std::max(size, std::abs(x));
  const double rounding = std::max(size * std::numeric_limits<double>::epsilon(),
                                   std::numeric_limits<double>::min());
  std::vector<std::vector<double>> vectors;
  Basis basis(n, values.size());
  std::uint64_t random = 1;
  double shift = std::numeric_limits<double>::infinity();
  for (const double value : values) {
    shift = std::min(value, shift - kApart * rounding);
    const ShiftedFactors factors(diagonal, beside, shift, rounding);
    std::vector<double> x(n);
    for (double& v : x) {
      random = random * 6364136223846793005U + 1442695040888963407U;
      v = static_cast<double>(random >> 40) * 0x1p-24 - 0.5;
    }
    for (int round = 0; round < kRounds; ++round) {
      factors.solve(x);
      if (!normalise(x)) return std::nullopt;
      basis.remove_projection(x);
      if (!normalise(x)) return std::nullopt;
    }
    basis.remove_projection(x);  // again because of rounding
    if (!normalise(x) || residual(diagonal, beside, value, x) > kConverged * size) {
      return std::nullopt;
    }
    basis.add(x);
    vectors.push_back(std::move(x));
  }
  return vectors;
}

}  // namespace rlpc
