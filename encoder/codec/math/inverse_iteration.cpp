#include "encoder/codec/math/inverse_iteration.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/math/matrix_products.h"

namespace rlpc {
namespace {

// The LU factorisation, with row exchanges, of a tridiagonal matrix minus `shift` times the
// identity.
class ShiftedFactors {
 public:
  ShiftedFactors(std::span<const double> diagonal, std::span<const double> subdiagonal,
                 double shift, double min_pivot)
      : rows_(diagonal.size()) {
    const std::size_t n = rows_.size();
    Row row{diagonal[0] - shift, n > 1 ? subdiagonal[0] : 0.0, 0.0};
    for (std::size_t i = 0; i + 1 < n; ++i) {
      Row next{subdiagonal[i], diagonal[i + 1] - shift, i + 2 < n ? subdiagonal[i + 1] : 0.0};
      row.exchanged = std::abs(next.pivot) > std::abs(row.pivot);
      if (row.exchanged) {
        std::swap(row.pivot, next.pivot);
        std::swap(row.right, next.right);
        std::swap(row.far, next.far);
      }
      row.pivot = away_from_zero(row.pivot, min_pivot);
      row.factor = next.pivot / row.pivot;
      rows_[i] = row;
      row = Row{next.right - row.factor * row.right, next.far - row.factor * row.far, 0.0};
    }
    row.pivot = away_from_zero(row.pivot, min_pivot);
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

  static double away_from_zero(double pivot, double min) {
    return std::abs(pivot) >= min ? pivot : std::copysign(min, pivot);
  }

  std::vector<Row> rows_;
};

// Returns the inverse of the upper Cholesky factor of a matrix, [count][count], of which the
// lower triangle is given. None if a pivot is barely above 0.
std::optional<std::vector<double>> inverse_of_factor(std::vector<double> lower,
                                                     std::size_t count) {
  constexpr double kMinPivot = 1e-8;
  for (std::size_t i = 0; i < count; ++i) {
    double* const row = &lower[i * count];
    for (std::size_t j = 0; j <= i; ++j) {
      const double* const other = &lower[j * count];
      double sum = row[j];
      for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
      if (j == i && !(sum > kMinPivot)) return std::nullopt;
      row[j] = j == i ? std::sqrt(sum) : sum / other[j];
    }
  }
  std::vector<double> inverse(count * count, 0.0);  // [k][j], k <= j
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t j = k; j < count; ++j) {
      double sum = j == k ? 1.0 : 0.0;
      for (std::size_t i = k; i < j; ++i) sum -= lower[j * count + i] * inverse[k * count + i];
      inverse[k * count + j] = sum / lower[j * count + j];
    }
  }
  return inverse;
}

// Returns the same for a matrix that differs so little from the identity that squares of the
// differences vanish by rounding.
std::vector<double> inverse_near_identity(std::span<const double> lower, std::size_t count) {
  std::vector<double> inverse(count * count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) inverse[j * count + i] = -lower[i * count + j];
    inverse[i * count + i] = 1.5 - 0.5 * lower[i * count + i];
  }
  return inverse;
}

double largest_beside_diagonal(std::span<const double> lower, std::size_t count) {
  double largest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      largest = std::max(largest, std::abs(lower[i * count + j]));
    }
  }
  return largest;
}

// Orthonormalises the columns of a matrix [n][count], which are of unit length and almost
// orthogonal unless their values are equal. False if one of them depends on those before.
bool orthonormalise(std::vector<double>& columns, std::size_t count) {
  constexpr double kNear = 1e-9;
  constexpr int kMax = 4;  // usually, one or two are enough
  for (int i = 0; i < kMax; ++i) {
    const std::vector<double> gram = gram_matrix(columns, count);
    const bool is_near = largest_beside_diagonal(gram, count) < kNear;
    const auto inverse = is_near ? std::optional(inverse_near_identity(gram, count))
                                 : inverse_of_factor(gram, count);
    if (!inverse) return false;
    columns = matrix_product(columns, count, *inverse, count);
    if (is_near) return true;
  }
  return false;
}

// Scales a vector to unit length. Returns false if it is zero or not finite.
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

std::vector<double> random_vector(std::size_t size, std::uint64_t seed) {
  std::uint64_t random = (seed + 1) * 0x9E3779B97F4A7C15U;
  std::vector<double> x(size);
  for (double& v : x) {
    random = random * 6364136223846793005U + 1442695040888963407U;
    v = static_cast<double>(random >> 40) * 0x1p-24 - 0.5;
  }
  return x;
}

// Returns the largest magnitude of an element of (matrix - value) x.
double residual(std::span<const double> diagonal, std::span<const double> subdiagonal,
                double value, const std::vector<double>& x) {
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double sum = (diagonal[i] - value) * x[i];
    if (i > 0) sum += subdiagonal[i - 1] * x[i - 1];
    if (i + 1 < x.size()) sum += subdiagonal[i] * x[i + 1];
    worst = std::max(worst, std::abs(sum));
  }
  return worst;
}

}  // namespace

std::optional<std::vector<std::vector<double>>> tridiagonal_eigenvectors(
    std::span<const double> diagonal, std::span<const double> subdiagonal,
    std::span<const double> values) {
  constexpr int kRounds = 3;
  constexpr double kConverged =
      1e-11;  // residual relative to the largest element of the matrix
  constexpr double kApart =
      8.0;  // in units of rounding: equal values are separated by this much
  constexpr std::size_t kTogether = 8;  // values of a pass
  const std::size_t n = diagonal.size();
  const std::size_t count = values.size();
  double size = 0.0;
  for (const double x : diagonal) size = std::max(size, std::abs(x));
  for (const double x : subdiagonal) size = std::max(size, std::abs(x));
  const double rounding = std::max(size * std::numeric_limits<double>::epsilon(),
                                   std::numeric_limits<double>::min());
  std::vector<double> shifts;
  double shift = std::numeric_limits<double>::infinity();
  for (const double value : values) {
    shift = std::min(value, shift - kApart * rounding);
    shifts.push_back(shift);
  }
  std::vector<std::vector<double>> vectors(count);
  std::vector<std::uint8_t> failed(count, 0);
  for_ranges(count, kTogether, [&](std::size_t l, std::size_t end) {
    for (; l < end; ++l) {
      const ShiftedFactors factors(diagonal, subdiagonal, shifts[l], rounding);
      vectors[l] = random_vector(n, l);
      for (int round = 0; round < kRounds && failed[l] == 0; ++round) {
        factors.solve(vectors[l]);
        if (!normalise(vectors[l])) failed[l] = 1;
      }
    }
  });
  if (std::find(failed.begin(), failed.end(), 1) != failed.end()) return std::nullopt;
  std::vector<double> columns = as_columns(vectors, n);
  if (!orthonormalise(columns, count)) return std::nullopt;
  for (std::size_t l = 0; l < count; ++l) {
    for (std::size_t i = 0; i < n; ++i) vectors[l][i] = columns[i * count + l];
    if (residual(diagonal, subdiagonal, values[l], vectors[l]) > kConverged * size) {
      return std::nullopt;
    }
  }
  return vectors;
}

}  // namespace rlpc
