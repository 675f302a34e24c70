// The heavy products of the analysis: loops over independent outputs, each summed in one order,
// so that vectorisation changes nothing. Matrices are row-major.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace rlpc {

// Lower triangle, with the diagonal, of rows^T rows; [width][width], the rest is 0.
std::vector<double> gram_matrix(std::span<const double> rows, std::size_t width);

// The same, added to that of the rows before: if these are a multiple of 4, the sums are those
// of all rows together.
void add_gram_matrix(std::span<const double> rows, std::size_t width, std::span<double> gram);

// Left columns of a, as many as b has rows, times b.
//
//   a       [num_rows][a_width]
//   b       [inner][b_width], inner <= a_width
//   result  [num_rows][b_width]
std::vector<double> matrix_product(std::span<const double> a, std::size_t a_width,
                                   std::span<const double> b, std::size_t b_width);

// The same, added to a result.
void add_matrix_product(std::span<const double> a, std::size_t a_width,
                        std::span<const double> b, std::size_t b_width,
                        std::span<double> result);

// A row times b, each sum in the order of the rows of b.
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
