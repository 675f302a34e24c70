#include "encoder/math/matrix_products.h"

#include <algorithm>

#include "encoder/math/widest.h"
#include "encoder/parallel/for_each.h"

namespace rlpc {
namespace {

constexpr std::size_t kTogether = 4;
// Products of at least this many numbers are shared among threads.
constexpr std::size_t kWorthThreads = 1 << 20;

// A linear combination of four rows, which is summed before it is added to an output. Loops
// over outputs use two of these at a time: reading and writing the outputs in the second-level
// cache costs more than the arithmetic.
template <class T>
class FourProducts {
 public:
  // Factors are x[0], x[stride], ...; rows are `width` apart.
  FourProducts(const T* x, std::size_t stride, const T* rows, std::size_t width)
      : x0_(x[0]),
        x1_(x[stride]),
        x2_(x[2 * stride]),
        x3_(x[3 * stride]),
        r0_(rows),
        r1_(rows + width),
        r2_(rows + 2 * width),
        r3_(rows + 3 * width) {}
  T operator[](std::size_t j) const {
    return (x0_ * r0_[j] + x1_ * r1_[j]) + (x2_ * r2_[j] + x3_ * r3_[j]);
  }

 private:
  T x0_, x1_, x2_, x3_;
  const T *r0_, *r1_, *r2_, *r3_;
};

// Rows `first` to end - 1 of the Gram matrix.
RLPC_WIDEST void add_gram(std::span<const double> rows, std::size_t width, std::size_t first,
                          std::size_t end, std::span<double> result) noexcept {
  const std::size_t num_rows = rows.size() / width;
  std::size_t r = 0;
  for (; r + 2 * kTogether <= num_rows; r += 2 * kTogether) {
    const double* four = &rows[r * width];
    const double* next = four + kTogether * width;
    for (std::size_t i = first; i < end; ++i) {
      double* out = &result[i * width];
      const FourProducts<double> here(four + i, width, four, width);
      const FourProducts<double> there(next + i, width, next, width);
      for (std::size_t j = 0; j <= i; ++j) out[j] = (out[j] + here[j]) + there[j];
    }
  }
  for (; r + kTogether <= num_rows; r += kTogether) {
    const double* four = &rows[r * width];
    for (std::size_t i = first; i < end; ++i) {
      double* out = &result[i * width];
      const FourProducts<double> products(four + i, width, four, width);
      for (std::size_t j = 0; j <= i; ++j) out[j] += products[j];
    }
  }
  for (; r < num_rows; ++r) {
    const double* row = &rows[r * width];
    for (std::size_t i = first; i < end; ++i) {
      double* out = &result[i * width];
      for (std::size_t j = 0; j <= i; ++j) out[j] += row[i] * row[j];
    }
  }
}

template <class T>
struct Product {
  std::span<const T> a;
  std::size_t a_width;
  std::span<const T> b;
  std::size_t b_width;
  T* out;
};

template <class T>
[[gnu::always_inline]] inline void add_product_of(const Product<T>& p) {
  const std::size_t width = p.b_width;
  const std::size_t num_rows = p.a_width == 0 ? 0 : p.a.size() / p.a_width;
  const std::size_t inner = width == 0 ? 0 : p.b.size() / width;
  const T* b = p.b.data();
  T* out = p.out;  // b may have no columns
  std::size_t r = 0;
  for (; r + 2 <= num_rows; r += 2, out += 2 * width) {
    const T* x = p.a.data() + r * p.a_width;
    const T* y = x + p.a_width;
    T* below = out + width;
    std::size_t i = 0;
    for (; i + kTogether <= inner; i += kTogether) {
      const FourProducts<T> of_x(x + i, 1, b + i * width, width);
      const FourProducts<T> of_y(y + i, 1, b + i * width, width);
      for (std::size_t j = 0; j < width; ++j) {
        out[j] += of_x[j];
        below[j] += of_y[j];
      }
    }
    for (; i < inner; ++i) {
      for (std::size_t j = 0; j < width; ++j) {
        out[j] += x[i] * b[i * width + j];
        below[j] += y[i] * b[i * width + j];
      }
    }
  }
  if (r == num_rows) return;
  const T* x = p.a.data() + r * p.a_width;
  std::size_t i = 0;
  for (; i + kTogether <= inner; i += kTogether) {
    const FourProducts<T> products(x + i, 1, b + i * width, width);
    for (std::size_t j = 0; j < width; ++j) out[j] += products[j];
  }
  for (; i < inner; ++i) {
    for (std::size_t j = 0; j < width; ++j) out[j] += x[i] * b[i * width + j];
  }
}

RLPC_WIDEST void add_product(const Product<double>& product) noexcept {
  add_product_of(product);
}
RLPC_WIDEST void add_product(const Product<float>& product) noexcept {
  add_product_of(product);
}

// Rows `first` to end - 1 of the transpose of a, times b.
RLPC_WIDEST void add_transposed_product(const Product<float>& p, std::size_t first,
                                        std::size_t end) noexcept {
  const std::size_t width = p.b_width;
  const std::size_t num_rows = p.a.size() / p.a_width;
  std::size_t r = 0;
  for (; r + kTogether <= num_rows; r += kTogether) {
    for (std::size_t i = first; i < end; ++i) {
      float* out = p.out + i * width;
      const FourProducts<float> products(&p.a[r * p.a_width + i], p.a_width, &p.b[r * width],
                                         width);
      for (std::size_t j = 0; j < width; ++j) out[j] += products[j];
    }
  }
  for (; r < num_rows; ++r) {
    for (std::size_t i = first; i < end; ++i) {
      float* out = p.out + i * width;
      for (std::size_t j = 0; j < width; ++j) {
        out[j] += p.a[r * p.a_width + i] * p.b[r * width + j];
      }
    }
  }
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
  constexpr std::size_t kRows = 32;  // to a pass of the loop
  if (rows.size() * width < kWorthThreads) return add_gram(rows, width, 0, width, gram);
  for_ranges(width, kRows, [&](std::size_t first, std::size_t end) {
    add_gram(rows, width, first, end, gram);
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
  add_product(Product<double>{a, a_width, b, b_width, result.data()});
}

std::vector<float> matrix_product(std::span<const float> a, std::size_t a_width,
                                  std::span<const float> b, std::size_t b_width) {
  constexpr std::size_t kRows = 64;  // to a pass of the loop
  const std::size_t num_rows = a.size() / a_width;
  std::vector<float> result(num_rows * b_width);
  for_ranges(num_rows, kRows, [&](std::size_t first, std::size_t end) {
    add_product(Product<float>{a.subspan(first * a_width, (end - first) * a_width), a_width, b,
                               b_width, result.data() + first * b_width});
  });
  return result;
}

std::vector<float> transposed_product(std::span<const float> a, std::size_t a_width,
                                      std::span<const float> b, std::size_t b_width) {
  constexpr std::size_t kRows = 64;  // to a pass of the loop
  std::vector<float> result(a_width * b_width);
  for_ranges(a_width, kRows, [&](std::size_t first, std::size_t end) {
    add_transposed_product({a, a_width, b, b_width, result.data()}, first, end);
  });
  return result;
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
