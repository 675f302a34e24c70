#include "encoder/codec/math/principal_components.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "encoder/codec/math/eigenvectors.h"
#include "encoder/codec/math/matrix_products.h"

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
double energy_floor(double total_energy, double min_energy) {
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

// Returns the number of columns of a sample that shows the components of a matrix, if they are
// few; 0: all columns are used.
std::size_t sampled_columns(const TrajectoryRows& rows) {
  constexpr std::size_t kWideMatrix = 384;  // fixed: time; narrower ones take little
  constexpr std::size_t kPart = 4;          // fixed: time; a sixteenth of that of all columns
  constexpr std::size_t kMaxSample = 512;   // fixed: time
  const std::size_t count = std::min(rows.num_frames / kPart, kMaxSample);
  return rows.num_frames > kWideMatrix && rows.num_values > count ? count : 0;
}

// Returns the components of evenly spaced columns, with a reduced min_energy for safety. None:
// there are too many.
std::optional<EigenPairs> components_of_sample(const TrajectoryRows& rows, std::size_t sampled,
                                               double min_energy, double& total_energy) {
  constexpr double kMin = 0.25;  // fixed: energies in the sample differ from those of all
  const std::size_t max_components = sampled / 4;  // fixed: of more, it would show too little
  const std::size_t width = rows.num_frames;
  std::vector<double> gram(sampled * sampled);
  std::vector<double> sample;
  double sampled_energy = 0.0;
  for_some_rows(rows, [&](std::span<const double> some) {
    for (const double x : some) total_energy += x * x;
    sample.clear();
    for (std::size_t row = 0; row < some.size(); row += width) {
      for (std::size_t i = 0; i < sampled; ++i)
        sample.push_back(some[row + i * width / sampled]);
    }
    for (const double x : sample) sampled_energy += x * x;
    add_gram_matrix(sample, sampled, gram);
  });
  const double part = static_cast<double>(sampled) / static_cast<double>(width);
  EigenPairs pairs =
      leading_eigenvectors(gram, sampled, max_components + 1,
                           energy_floor(sampled_energy, kMin * part * min_energy));
  if (pairs.vectors.size() > max_components) return std::nullopt;
  return pairs;
}

// Makes vectors orthonormal, in order; leaves out those that depend on others.
std::vector<std::vector<double>> orthonormal(std::vector<std::vector<double>> vectors) {
  constexpr double kIndependent = 1e-10;  // fixed: part of the squared length; rounding
  std::vector<std::vector<double>> basis;
  for (std::vector<double>& v : vectors) {
    const double before = squared_norm(v);
    for (int round = 0; round < 2; ++round) {
      for (const std::vector<double>& b : basis) {
        double product = 0.0;
        for (std::size_t i = 0; i < v.size(); ++i) product += v[i] * b[i];
        subtract_multiple(product, b, v);
      }
    }
    const double left = squared_norm(v);
    if (!(left > kIndependent * before)) continue;
    for (double& x : v) x /= std::sqrt(left);
    basis.push_back(std::move(v));
  }
  return basis;
}

std::vector<std::vector<double>> rows_of(const std::vector<double>& matrix, std::size_t width) {
  std::vector<std::vector<double>> rows;
  for (std::size_t first = 0; first < matrix.size(); first += width) {
    const auto from = matrix.begin() + static_cast<std::ptrdiff_t>(first);
    rows.emplace_back(from, from + static_cast<std::ptrdiff_t>(width));
  }
  return rows;
}

// Returns orthonormal temporal vectors that follow from the spatial ones of a sample.
std::vector<std::vector<double>> temporal_basis(const TrajectoryRows& rows, std::size_t sampled,
                                                const EigenPairs& sample_pairs) {
  const std::size_t width = rows.num_frames;
  const std::size_t count = sample_pairs.vectors.size();
  std::vector<double> sums(count * width);  // [count][width]
  for_some_rows(rows, [&](std::span<const double> some) {
    const std::size_t together = some.size() / width;
    std::vector<double> spatial(count * together);  // [count][row]
    for (std::size_t row = 0; row < together; ++row) {
      for (std::size_t k = 0; k < count; ++k) {
        double sum = 0.0;
        for (std::size_t i = 0; i < sampled; ++i) {
          sum += some[row * width + i * width / sampled] * sample_pairs.vectors[k][i];
        }
        spatial[k * together + row] = sum;
      }
    }
    add_matrix_product(spatial, together, some, width, sums);
  });
  return orthonormal(rows_of(sums, width));
}

// Returns the basis after one more step of subspace iteration: motion that the sampled frames
// hardly show comes in.
std::vector<std::vector<double>> improved_basis(const TrajectoryRows& rows,
                                                const std::vector<std::vector<double>>& basis) {
  const std::size_t width = rows.num_frames;
  const std::size_t count = basis.size();
  const std::vector<double> columns = as_columns(basis, width);
  std::vector<double> sums(count * width);  // [count][width]
  for_some_rows(rows, [&](std::span<const double> some) {
    const std::size_t together = some.size() / width;
    const std::vector<double> products = matrix_product(some, width, columns, count);
    std::vector<double> spatial(count * together);  // [count][row]
    for (std::size_t row = 0; row < together; ++row) {
      for (std::size_t k = 0; k < count; ++k) {
        spatial[k * together + row] = products[row * count + k];
      }
    }
    add_matrix_product(spatial, together, some, width, sums);
  });
  return orthonormal(rows_of(sums, width));
}

// Returns the principal components within the subspace of a sample of the columns. None: a
// sample is not enough.
std::optional<ComponentsByRow> components_in_subspace(const TrajectoryRows& rows,
                                                      std::size_t sampled,
                                                      std::size_t max_components,
                                                      double min_energy) {
  ComponentsByRow result;
  const auto sample_pairs =
      components_of_sample(rows, sampled, min_energy, result.total_energy);
  if (!sample_pairs) return std::nullopt;
  // fixed: Time. On a knight of 8454 columns, the further step takes a third of this function
  // and saves no bytes.
  constexpr std::size_t kImproved = 1536;
  const std::size_t width = rows.num_frames;
  std::vector<std::vector<double>> basis = temporal_basis(rows, sampled, *sample_pairs);
  if (width <= kImproved) basis = improved_basis(rows, basis);
  const std::size_t count = basis.size();
  if (count == 0) return result;
  const std::vector<double> columns = as_columns(basis, width);
  std::vector<double> projected;  // [num_values][count]
  projected.reserve(rows.num_values * count);
  std::vector<double> gram(count * count);
  for_some_rows(rows, [&](std::span<const double> some) {
    const std::vector<double> products = matrix_product(some, width, columns, count);
    add_gram_matrix(products, count, gram);
    projected.insert(projected.end(), products.begin(), products.end());
  });
  EigenPairs pairs = leading_eigenvectors(gram, count, max_components,
                                          energy_floor(result.total_energy, min_energy));
  const std::size_t found = pairs.vectors.size();
  for (const std::vector<double>& vector : pairs.vectors) {
    std::vector<double>& temporal = result.temporal.emplace_back(width);
    for (std::size_t k = 0; k < count; ++k) subtract_multiple(-vector[k], basis[k], temporal);
  }
  const std::vector<double> spatial =
      matrix_product(projected, count, as_columns(pairs.vectors, count), found);
  result.spatial.assign(spatial.begin(), spatial.end());
  result.energy = std::move(pairs.values);
  return result;
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
  const double min = energy_floor(pc.total_energy, min_energy);
  EigenPairs pairs = leading_eigenvectors(gram_matrix(by_frames ? matrix.a : transposed, width),
                                          width, max_components, min);
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
  if (width == 0) return result;
  if (const std::size_t sampled = sampled_columns(rows); sampled > 0) {
    auto found = components_in_subspace(rows, sampled, max_components, min_energy);
    if (found) return *found;
    // Rows are read again.
  }
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
  std::vector<double> gram(width * width);
  for_some_rows(rows, [&](std::span<const double> some) {
    for (const double x : some) result.total_energy += x * x;
    add_gram_matrix(some, width, gram);
  });
  EigenPairs pairs = leading_eigenvectors(gram, width, max_components,
                                          energy_floor(result.total_energy, min_energy));
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
