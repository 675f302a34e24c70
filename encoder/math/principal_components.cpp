#include "encoder/math/principal_components.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include "encoder/math/eigenvectors.h"
#include "encoder/math/matrix_products.h"

namespace rlpc {
namespace {

std::vector<double> transpose(const TrajectoryMatrix& m) {
  std::vector<double> t(m.a.size());
  for (std::size_t i = 0; i < m.num_values; ++i) {
    for (std::size_t f = 0; f < m.num_frames; ++f) t[f * m.num_values + i] = m.row(i)[f];
  }
  return t;
}

// Excludes components that are only rounding errors, in a matrix of low rank.
double least_energy(double total_energy, double min_energy) {
  constexpr double kRankTolerance = 1e-13;
  return std::max(min_energy, kRankTolerance * total_energy);
}

double squared_norm(const std::vector<double>& a) {
  double sum = 0.0;
  for (const double x : a) sum += x * x;
  return sum;
}

// Visits all rows in order, a block at a time.
void for_some_rows(const TrajectoryRows& rows,
                   const std::function<void(std::span<const double>)>& use) {
  constexpr std::size_t kTogether = 256;  // a multiple of 4 (add_gram_matrix)
  std::vector<double> some;
  for (std::size_t first = 0; first < rows.num_values; first += kTogether) {
    some.resize(std::min(kTogether, rows.num_values - first) * rows.num_frames);
    rows.write(first, some);
    use(some);
  }
}

}  // namespace

PrincipalComponents principal_components(const TrajectoryMatrix& matrix,
                                         std::size_t max_components, double min_energy) {
  PrincipalComponents pc;
  if (matrix.num_values == 0 || matrix.num_frames == 0) return pc;
  pc.total_energy = squared_norm(matrix.a);
  const bool by_frames = matrix.num_frames <= matrix.num_values;
  const std::vector<double> transposed = by_frames ? std::vector<double>{} : transpose(matrix);
  const std::size_t width = by_frames ? matrix.num_frames : matrix.num_values;
  const double least = least_energy(pc.total_energy, min_energy);
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

ComponentsByRow components_by_row(const TrajectoryRows& rows, std::size_t max_components,
                                  double min_energy) {
  ComponentsByRow result;
  const std::size_t width = rows.num_frames;
  if (width > rows.num_values) {
    TrajectoryMatrix matrix{rows.num_values, width,
                            std::vector<double>(rows.num_values * width)};
    rows.write(0, matrix.a);
    PrincipalComponents pc = principal_components(matrix, max_components, min_energy);
    const std::vector<double> spatial = as_columns(pc.spatial, rows.num_values);
    result.spatial.assign(spatial.begin(), spatial.end());
    result.total_energy = pc.total_energy;
    result.energy = std::move(pc.energy);
    result.temporal = std::move(pc.temporal);
    return result;
  }
  if (width == 0) return result;
  std::vector<double> gram(width * width);
  for_some_rows(rows, [&](std::span<const double> some) {
    for (const double x : some) result.total_energy += x * x;
    add_gram_matrix(some, width, gram);
  });
  EigenPairs pairs = leading_eigenvectors(gram, width, max_components,
                                          least_energy(result.total_energy, min_energy));
  result.energy = std::move(pairs.values);
  result.temporal = std::move(pairs.vectors);
  const std::vector<double> vectors = as_columns(result.temporal, width);
  result.spatial.reserve(rows.num_values * result.temporal.size());
  for_some_rows(rows, [&](std::span<const double> some) {
    const std::vector<double> products =
        matrix_product(some, width, vectors, result.temporal.size());
    result.spatial.insert(result.spatial.end(), products.begin(), products.end());
  });
  return result;
}

}  // namespace rlpc
