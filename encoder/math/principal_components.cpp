#include "encoder/math/principal_components.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include "encoder/math/eigenvectors.h"
#include "encoder/math/few_components.h"
#include "encoder/math/matrix_products.h"
#include "encoder/parallel/for_each.h"

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

// Writes consecutive rows, starting with row `first`.
void write_rows(const TrajectoryRows& rows, std::size_t first, std::span<double> to) {
  constexpr std::size_t kTogether = 32;  // rows to a pass of the loop
  const std::size_t width = rows.num_frames;
  for_ranges(to.size() / width, kTogether, [&](std::size_t begin, std::size_t end) {
    rows.write(first + begin, to.subspan(begin * width, (end - begin) * width));
  });
}

// Visits all rows in order, a block at a time.
void for_some_rows(const TrajectoryRows& rows,
                   const std::function<void(std::span<const double>)>& use) {
  constexpr std::size_t kTogether = 256;  // a multiple of 4 (add_gram_matrix)
  std::vector<double> some;
  for (std::size_t first = 0; first < rows.num_values; first += kTogether) {
    some.resize(std::min(kTogether, rows.num_values - first) * rows.num_frames);
    write_rows(rows, first, some);
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

namespace {

// From the eigenvectors of the smaller of the two Gram matrices.
ComponentsByRow all_components(const TrajectoryRows& rows, std::span<const float> single,
                               std::size_t max_components, double least) {
  ComponentsByRow result;
  const std::size_t width = rows.num_frames;
  if (width > rows.num_values) {
    TrajectoryMatrix matrix{rows.num_values, width,
                            std::vector<double>(rows.num_values * width)};
    write_rows(rows, 0, matrix.a);
    PrincipalComponents pc = principal_components(matrix, max_components, least);
    const std::vector<double> spatial = as_columns(pc.spatial, rows.num_values);
    result.spatial.assign(spatial.begin(), spatial.end());
    result.energy = std::move(pc.energy);
    result.temporal = std::move(pc.temporal);
    return result;
  }
  std::vector<double> gram(width * width);
  for_some_rows(rows,
                [&](std::span<const double> some) { add_gram_matrix(some, width, gram); });
  EigenPairs pairs = leading_eigenvectors(gram, width, max_components, least, false);
  result.energy = std::move(pairs.values);
  result.temporal = std::move(pairs.vectors);
  const std::vector<double> vectors = as_columns(result.temporal, width);
  const std::vector<float> of_single(vectors.begin(), vectors.end());
  result.spatial = matrix_product(single, width, of_single, result.temporal.size());
  return result;
}

}  // namespace

ComponentsByRow components_by_row(const TrajectoryRows& rows, std::size_t max_components,
                                  double min_energy) {
  const std::size_t width = rows.num_frames;
  if (width == 0 || rows.num_values == 0) return {};
  double total_energy = 0.0;
  std::vector<float> single;
  single.reserve(rows.num_values * width);
  for_some_rows(rows, [&](std::span<const double> some) {
    for (const double x : some) {
      total_energy += x * x;
      single.push_back(static_cast<float>(x));
    }
  });
  const double least = least_energy(total_energy, min_energy);
  if (auto few = few_components(single, width, max_components, least)) {
    few->total_energy = total_energy;
    return std::move(*few);
  }
  ComponentsByRow result = all_components(rows, single, max_components, least);
  result.total_energy = total_energy;
  return result;
}

}  // namespace rlpc
