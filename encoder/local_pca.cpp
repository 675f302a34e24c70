#include "encoder/local_pca.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/eigenvectors.h"
#include "encoder/matrix_products.h"

namespace rlpc {
namespace {

constexpr double kRankTolerance = 1e-13;

std::vector<double> transpose(const TrajectoryMatrix& m) {
  std::vector<double> t(m.a.size());
  for (std::size_t i = 0; i < m.num_values; ++i) {
    for (std::size_t f = 0; f < m.num_frames; ++f) t[f * m.num_values + i] = m.row(i)[f];
  }
  return t;
}

// out[k][row] = sum over i of rows[row][i] * vectors[k][i]
std::vector<std::vector<double>> project(const std::vector<double>& rows, std::size_t width,
                                         const std::vector<std::vector<double>>& vectors) {
  const std::size_t count = vectors.size();
  std::vector<double> by_element(width * count);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < width; ++i) by_element[i * count + k] = vectors[k][i];
  }
  const std::vector<double> products = matrix_product(rows, width, by_element, count);
  const std::size_t num_rows = rows.size() / width;
  std::vector<std::vector<double>> out(count, std::vector<double>(num_rows));
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t r = 0; r < num_rows; ++r) out[k][r] = products[r * count + k];
  }
  return out;
}

}  // namespace

PrincipalComponents principal_components(const TrajectoryMatrix& matrix,
                                         std::size_t max_components, double min_energy) {
  PrincipalComponents pc;
  if (matrix.num_values == 0 || matrix.num_frames == 0) return pc;
  for (const double x : matrix.a) pc.total_energy += x * x;

  const bool by_frames = matrix.num_frames <= matrix.num_values;
  const std::vector<double> transposed = by_frames ? std::vector<double>{} : transpose(matrix);
  const std::size_t width = by_frames ? matrix.num_frames : matrix.num_values;
  // What rounding leaves of a matrix of lower rank is no component.
  const double least = std::max(min_energy, kRankTolerance * pc.total_energy);
  EigenPairs pairs = leading_eigenvectors(gram_matrix(by_frames ? matrix.a : transposed, width),
                                          width, max_components, least);
  pc.energy = std::move(pairs.values);
  std::vector<std::vector<double>> vectors = std::move(pairs.vectors);
  if (by_frames) {
    pc.spatial = project(matrix.a, matrix.num_frames, vectors);
    pc.temporal = std::move(vectors);
    return pc;
  }
  // Eigenvectors are spatial here: move sigma from the temporal to the spatial factor.
  pc.temporal = project(transposed, matrix.num_values, vectors);
  pc.spatial = std::move(vectors);
  for (std::size_t l = 0; l < pc.spatial.size(); ++l) {
    double norm2 = 0.0;
    for (const double x : pc.temporal[l]) norm2 += x * x;
    const double sigma = std::sqrt(norm2);
    for (double& x : pc.temporal[l]) x /= sigma;
    for (double& x : pc.spatial[l]) x *= sigma;
  }
  return pc;
}

}  // namespace rlpc
