#include "encoder/codec/partition/spectral.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/eigenvectors.h"
#include "encoder/codec/partition/k_means.h"
#include "encoder/codec/partition/surface_distance.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kSamples = 400;      // fixed: time is cubic in them
constexpr std::uint32_t kSamplesOfPart = 2;  // fixed: for k-means to choose from
constexpr std::size_t kMaxVectors = 32;      // fixed: time

// Returns D^-1/2 W D^-1/2, where W is exp(-d / 2) of the distances d, relative to their mean.
//
// Note: the paper divides d by the square of the mean, which depends on its unit.
std::vector<double> affinity(const SurfaceSamples& samples) {
  constexpr double kLog2E = 1.4426950408889634;  // fixed: log2(e)
  constexpr double kMin = -800.0;                // fixed: smaller powers of two are zero
  const std::size_t n = samples.count;
  double mean = 0.0;
  for (const double d : samples.distance) mean += d;
  mean /= static_cast<double>(n * n);
  std::vector<double> w(n * n);
  std::vector<double> degree(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double d = mean > 0.0 ? samples.distance[i * n + j] / mean : 0.0;
      w[i * n + j] = det_exp2(std::max(-0.5 * d * kLog2E, kMin));
      degree[i] += w[i * n + j];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) w[i * n + j] /= std::sqrt(degree[i] * degree[j]);
  }
  return w;
}

// Returns the rows of the leading eigenvectors as points of the unit sphere, [n][dimensions].
std::vector<double> embedding(const std::vector<std::vector<double>>& vectors, std::size_t n) {
  const std::size_t dimensions = vectors.size();
  std::vector<double> points(n * dimensions);
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (const auto& vector : vectors) sum += vector[i] * vector[i];
    const double scale = sum > 0.0 ? 1.0 / std::sqrt(sum) : 0.0;
    for (std::size_t d = 0; d < dimensions; ++d) {
      points[i * dimensions + d] = vectors[d][i] * scale;
    }
  }
  return points;
}

}  // namespace

Partition spectral_partition(const Graph& graph, std::span<const Point3> points,
                             std::span<const Triangle> triangles, std::uint32_t count) {
  const std::uint32_t wanted =
      std::min(graph.num_vertices(), std::max(kSamples, kSamplesOfPart * count));
  const SurfaceSamples samples =
      sample_surface(graph, surface_lengths(graph, points, triangles), wanted);
  const auto vectors = leading_eigenvectors(affinity(samples), samples.count,
                                            std::min<std::size_t>(count, kMaxVectors), 0.0)
                           .vectors;
  const Partition sample_parts =
      k_means(embedding(vectors, samples.count), vectors.size(), count);
  Partition partition(graph.num_vertices());
  for (std::uint32_t v = 0; v < partition.size(); ++v) {
    partition[v] = sample_parts[samples.nearest[v]];
  }
  return partition;
}

}  // namespace rlpc
