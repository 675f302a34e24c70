#include "encoder/codec/math/matrix_products.h"

#include <algorithm>
#include <array>

#include "common/parallel/for_each.h"
#include "encoder/codec/math/widest.h"

namespace rlpc {
namespace {

constexpr std::size_t kTogether = 4;
// fixed: Products of fewer numbers take less time than waking another thread.
constexpr std::size_t kWorthThreads = 1 << 18;

// A linear combination of four rows, which is summed before it is added to an output. Loops
// over outputs use two of these at a time: reading and writing the outputs in the second-level
// cache costs more than the arithmetic.
class FourProducts {
 public:
  // Factors are x[0], x[stride], ...; rows are `width` apart.
  FourProducts(const double* x, std::size_t stride, const double* rows, std::size_t width)
      : x0_(x[0]),
        x1_(x[stride]),
        x2_(x[2 * stride]),
        x3_(x[3 * stride]),
        r0_(rows),
        r1_(rows + width),
        r2_(rows + 2 * width),
        r3_(rows + 3 * width) {}
  double operator[](std::size_t j) const {
    return (x0_ * r0_[j] + x1_ * r1_[j]) + (x2_ * r2_[j] + x3_ * r3_[j]);
  }

 private:
  double x0_, x1_, x2_, x3_;
  const double *r0_, *r1_, *r2_, *r3_;
};

// Adds rows `begin` to end - 1 of the Gram matrix.
RLPC_WIDEST void add_gram(std::span<const double> rows, std::size_t width, std::size_t begin,
                          std::size_t end, std::span<double> result) noexcept {
  const std::size_t num_rows = rows.size() / width;
  std::size_t r = 0;
  for (; r + 2 * kTogether <= num_rows; r += 2 * kTogether) {
    const double* four = &rows[r * width];
    const double* next = four + kTogether * width;
    for (std::size_t i = begin; i < end; ++i) {
      double* out = &result[i * width];
      const FourProducts first(four + i, width, four, width);
      const FourProducts second(next + i, width, next, width);
      for (std::size_t j = 0; j <= i; ++j) out[j] = (out[j] + first[j]) + second[j];
    }
  }
  for (; r + kTogether <= num_rows; r += kTogether) {
    const double* four = &rows[r * width];
    for (std::size_t i = begin; i < end; ++i) {
      double* out = &result[i * width];
      const FourProducts products(four + i, width, four, width);
      for (std::size_t j = 0; j <= i; ++j) out[j] += products[j];
    }
  }
  for (; r < num_rows; ++r) {
    const double* row = &rows[r * width];
    for (std::size_t i = begin; i < end; ++i) {
      double* out = &result[i * width];
      for (std::size_t j = 0; j <= i; ++j) out[j] += row[i] * row[j];
    }
  }
}

RLPC_WIDEST void add_row_product(const double* x, std::size_t inner, std::span<const double> b,
                                 std::size_t b_width, double* out) noexcept {
  std::size_t i = 0;
  for (; i + kTogether <= inner; i += kTogether) {
    const FourProducts products(x + i, 1, &b[i * b_width], b_width);
    for (std::size_t j = 0; j < b_width; ++j) out[j] += products[j];
  }
  for (; i < inner; ++i) {
    for (std::size_t j = 0; j < b_width; ++j) out[j] += x[i] * b[i * b_width + j];
  }
}

RLPC_WIDEST void add_product(std::span<const double> a, std::size_t a_width,
                             std::span<const double> b, std::size_t b_width,
                             std::span<double> result) noexcept {
  const std::size_t num_rows = a_width == 0 ? 0 : a.size() / a_width;
  const std::size_t inner = b_width == 0 ? 0 : b.size() / b_width;
  double* out = result.data();  // b may have no columns
  std::size_t r = 0;
  for (; r + 2 <= num_rows; r += 2, out += 2 * b_width) {
    const double* x = &a[r * a_width];
    const double* y = x + a_width;
    double* below = out + b_width;
    std::size_t i = 0;
    for (; i + kTogether <= inner; i += kTogether) {
      const FourProducts products_x(x + i, 1, &b[i * b_width], b_width);
      const FourProducts products_y(y + i, 1, &b[i * b_width], b_width);
      for (std::size_t j = 0; j < b_width; ++j) {
        out[j] += products_x[j];
        below[j] += products_y[j];
      }
    }
    for (; i < inner; ++i) {
      for (std::size_t j = 0; j < b_width; ++j) {
        out[j] += x[i] * b[i * b_width + j];
        below[j] += y[i] * b[i * b_width + j];
      }
    }
  }
  if (r < num_rows) add_row_product(&a[r * a_width], inner, b, b_width, out);
}

RLPC_WIDEST void four_columns(const double* x, std::size_t inner, const double* b,
                              std::size_t b_width, double* out) noexcept {
  std::array<double, 4> sum{};
  std::size_t i = 0;
  for (; i + kTogether <= inner; i += kTogether) {
    const FourProducts products(x + i, 1, b + i * b_width, b_width);
    for (std::size_t j = 0; j < 4; ++j) sum[j] += products[j];
  }
  for (; i < inner; ++i) {
    for (std::size_t j = 0; j < 4; ++j) sum[j] += x[i] * b[i * b_width + j];
  }
  for (std::size_t j = 0; j < 4; ++j) out[j] = sum[j];
}

RLPC_WIDEST void add_ordered_product(std::span<const double> row, std::span<const double> b,
                                     std::span<double> result) noexcept {
  const std::size_t width = result.size();
  double* out = result.data();
  std::size_t i = 0;
  for (; i + kTogether <= row.size(); i += kTogether) {
    const double* b0 = b.data() + i * width;  // there may be no columns
    const double* b1 = b0 + width;
    const double* b2 = b1 + width;
    const double* b3 = b2 + width;
    for (std::size_t j = 0; j < width; ++j) {
      out[j] = (((out[j] + row[i] * b0[j]) + row[i + 1] * b1[j]) + row[i + 2] * b2[j]) +
               row[i + 3] * b3[j];
    }
  }
  for (; i < row.size(); ++i) {
    for (std::size_t j = 0; j < width; ++j) out[j] += row[i] * b[i * width + j];
  }
}

RLPC_WIDEST void add_outer(double weight, std::span<const double> p, std::span<const double> x,
                           std::span<double> sum) noexcept {
  double* out = sum.data();
  for (const double factor : p) {
    for (std::size_t i = 0; i < x.size(); ++i) out[i] += weight * (x[i] * factor);
    out += x.size();
  }
}

RLPC_WIDEST void subtract(double factor, std::span<const double> from,
                          std::span<double> to) noexcept {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] -= factor * from[i];
}

}  // namespace

std::vector<double> gram_matrix(std::span<const double> rows, std::size_t width) {
  std::vector<double> result(width * width, 0.0);
  add_gram_matrix(rows, width, result);
  return result;
}

void add_gram_matrix(std::span<const double> rows, std::size_t width, std::span<double> gram) {
  constexpr std::size_t kRows = 32;  // fixed: rows of the result in a pass
  if (rows.size() * width < kWorthThreads) return add_gram(rows, width, 0, width, gram);
  for_ranges(width, kRows, [&](std::size_t begin, std::size_t end) {
    add_gram(rows, width, begin, end, gram);
  });
}

std::vector<double> matrix_product(std::span<const double> a, std::size_t a_width,
                                   std::span<const double> b, std::size_t b_width) {
  const std::size_t num_rows = a_width == 0 ? 0 : a.size() / a_width;
  std::vector<double> result(num_rows * b_width, 0.0);
  add_matrix_product(a, a_width, b, b_width, result);
  return result;
}

void add_matrix_product(std::span<const double> a, std::size_t a_width,
                        std::span<const double> b, std::size_t b_width,
                        std::span<double> result) {
  constexpr std::size_t kRows = 32;  // fixed: rows of the result in a pass
  if (a_width == 0 || a.size() * b_width < kWorthThreads) {
    return add_product(a, a_width, b, b_width, result);
  }
  for_ranges(a.size() / a_width, kRows, [&](std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    add_product(a.subspan(begin * a_width, count * a_width), a_width, b, b_width,
                result.subspan(begin * b_width, count * b_width));
  });
}

void four_columns_product(std::span<const double> row, std::span<const double> b,
                          std::size_t b_width, std::size_t first, std::span<double, 4> result) {
  four_columns(row.data(), row.size(), b.data() + first, b_width, result.data());
}

std::vector<double> ordered_product(std::span<const double> row, std::span<const double> b,
                                    std::size_t b_width) {
  std::vector<double> result(b_width, 0.0);
  add_ordered_product(row, b, result);
  return result;
}

void add_outer_product(double weight, std::span<const double> p, std::span<const double> x,
                       std::span<double> sum) {
  add_outer(weight, p, x, sum);
}

void subtract_multiple(double factor, std::span<const double> from, std::span<double> to) {
  subtract(factor, from, to);
}

std::vector<double> as_columns(std::span<const std::vector<double>> vectors,
                               std::size_t width) {
  std::vector<double> columns(width * vectors.size());
  for (std::size_t k = 0; k < vectors.size(); ++k) {
    for (std::size_t i = 0; i < width; ++i) columns[i * vectors.size() + k] = vectors[k][i];
  }
  return columns;
}

std::vector<std::vector<double>> project(std::span<const double> rows, std::size_t width,
                                         const std::vector<std::vector<double>>& vectors) {
  constexpr std::size_t kRowsTogether = 512;  // bounds the memory of products
  const std::size_t count = vectors.size();
  const std::size_t num_rows = rows.size() / width;
  const std::vector<double> columns = as_columns(vectors, width);
  std::vector<std::vector<double>> result(count, std::vector<double>(num_rows));
  for (std::size_t first = 0; first < num_rows; first += kRowsTogether) {
    const std::size_t together = std::min(kRowsTogether, num_rows - first);
    const std::vector<double> products =
        matrix_product(rows.subspan(first * width, together * width), width, columns, count);
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t r = 0; r < together; ++r) result[k][first + r] = products[r * count + k];
    }
  }
  return result;
}

}  // namespace rlpc
