// The time-critical matrix products of the analysis. Loops run over independent outputs, each
// with a fixed order of summation, so that vectorisation does not change results. Matrices are
// row-major.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rlpc {

// Returns the lower triangle of rows^T rows, with the diagonal, [width][width]; other elements
// are 0.
std::vector<double> gram_matrix(std::span<const double> rows, std::size_t width);

// Adds the Gram matrix of further rows. If the number of rows before is a multiple of 4, the
// result is bit-exactly that of all rows together.
void add_gram_matrix(std::span<const double> rows, std::size_t width, std::span<double> gram);

// Returns the leftmost columns of a, as many as b has rows, times b.
//
//   a       [num_rows][a_width]
//   b       [inner][b_width], inner <= a_width
//   result  [num_rows][b_width]
std::vector<double> matrix_product(std::span<const double> a, std::size_t a_width,
                                   std::span<const double> b, std::size_t b_width);

// Adds the same product to `result`.
void add_matrix_product(std::span<const double> a, std::size_t a_width,
                        std::span<const double> b, std::size_t b_width,
                        std::span<double> result);

// Computes four columns of the product of a row and b, bit-exactly like matrix_product().
//
//   row     [height of b]
//   first   first of the columns
void four_columns_product(std::span<const double> row, std::span<const double> b,
                          std::size_t b_width, std::size_t first, std::span<double, 4> result);

// Returns row * b, each element summed strictly in the order of the rows of b.
//
//   row     [width]
//   b       [width][b_width]
//   result  [b_width]
std::vector<double> ordered_product(std::span<const double> row, std::span<const double> b,
                                    std::size_t b_width);

// sum[k][i] += weight * (x[i] * p[k])
//
//   sum  [p.size()][x.size()]
void add_outer_product(double weight, std::span<const double> p, std::span<const double> x,
                       std::span<double> sum);

// to[i] -= factor * from[i]
void subtract_multiple(double factor, std::span<const double> from, std::span<double> to);

// columns[i][k] = vectors[k][i], i < width
std::vector<double> as_columns(std::span<const std::vector<double>> vectors, std::size_t width);

// result[k][row] = sum over i of rows[row][i] * vectors[k][i], i < width
std::vector<std::vector<double>> project(std::span<const double> rows, std::size_t width,
                                         const std::vector<std::vector<double>>& vectors);

}  // namespace rlpc
