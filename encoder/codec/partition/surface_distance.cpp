#include "encoder/codec/partition/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace rlpc {
namespace {

// tuned (off: 1): Weight of a geodesic distance, compared with an angular one. In the paper, it
// is close to zero.
constexpr double kGeodesic = 0.2;
constexpr double kConvex = 0.2;  // fixed: weight of convex angles, as in the paper

constexpr double kFar = std::numeric_limits<double>::infinity();

Point3 difference(const Point3& a, const Point3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double product(const Point3& a, const Point3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Returns unit normals of vertices, weighted by area; zero where there is none.
std::vector<Point3> vertex_normals(std::span<const Point3> points,
                                   std::span<const Triangle> triangles) {
  std::vector<Point3> normals(points.size(), Point3{});
  for (const Triangle& t : triangles) {
    const Point3 a = difference(points[t[1]], points[t[0]]);
    const Point3 b = difference(points[t[2]], points[t[0]]);
    const Point3 normal{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                        a[0] * b[1] - a[1] * b[0]};
    for (const std::uint32_t v : t) {
      for (std::size_t c = 0; c < 3; ++c) normals[v][c] += normal[c];
    }
  }
  for (Point3& n : normals) {
    const double length = std::sqrt(product(n, n));
    for (double& c : n) c = length > 0.0 ? c / length : 0.0;
  }
  return normals;
}

// Divides all values by their mean.
void normalise(std::vector<double>& values) {
  double sum = 0.0;
  for (const double x : values) sum += x;
  if (!(sum > 0.0)) return;
  const double scale = static_cast<double>(values.size()) / sum;
  for (double& x : values) x *= scale;
}

using Way = std::pair<double, std::uint32_t>;  // length, end
using Ways = std::priority_queue<Way, std::vector<Way>, std::greater<>>;

// Dijkstra's algorithm: shortens the distances of vertices that are nearer to `from` than known
// so far; reached(v) is called for each.
template <typename Reached>
void shorten(const Graph& graph, std::span<const double> lengths, std::uint32_t from,
             std::span<double> distance, const Reached& reached) {
  Ways ways;
  distance[from] = 0.0;
  reached(from);
  ways.emplace(0.0, from);
  while (!ways.empty()) {
    const auto [length, v] = ways.top();
    ways.pop();
    if (length > distance[v]) continue;
    for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
      const std::uint32_t u = graph.neighbour[e];
      if (length + lengths[e] >= distance[u]) continue;
      distance[u] = length + lengths[e];
      reached(u);
      ways.emplace(distance[u], u);
    }
  }
}

struct Cells {
  Graph graph;  // edges join samples whose cells touch
  std::vector<double> lengths;
};

// Finds the shortest path between two samples that crosses from cell to cell once.
Cells cells_of(const Graph& graph, std::span<const double> lengths,
               const std::vector<std::uint32_t>& nearest, const std::vector<double>& distance,
               std::uint32_t count) {
  struct Border {
    std::uint32_t from;
    std::uint32_t to;
    double length;
    bool operator<(const Border& other) const {
      if (from != other.from) return from < other.from;
      return to != other.to ? to < other.to : length < other.length;
    }
  };
  std::vector<Border> borders;
  for (std::uint32_t v = 0; v < graph.num_vertices(); ++v) {
    for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
      const std::uint32_t u = graph.neighbour[e];
      if (nearest[u] == nearest[v]) continue;
      borders.push_back({nearest[v], nearest[u], distance[v] + lengths[e] + distance[u]});
    }
  }
  std::sort(borders.begin(), borders.end());
  Cells cells;
  cells.graph.weight.assign(count, 1);
  cells.graph.first.assign(count + 1, 0);
  for (std::size_t i = 0; i < borders.size(); ++i) {
    const Border& b = borders[i];
    if (i > 0 && borders[i - 1].from == b.from && borders[i - 1].to == b.to) continue;
    cells.graph.neighbour.push_back(b.to);
    cells.graph.edge_weight.push_back(1);
    cells.lengths.push_back(b.length);
    ++cells.graph.first[b.from + 1];
  }
  for (std::uint32_t s = 0; s < count; ++s) cells.graph.first[s + 1] += cells.graph.first[s];
  return cells;
}

}  // namespace

std::vector<double> surface_lengths(const Graph& graph, std::span<const Point3> points,
                                    std::span<const Triangle> triangles) {
  const std::vector<Point3> normals = vertex_normals(points, triangles);
  std::vector<double> geodesic;
  std::vector<double> angular;
  for (std::uint32_t v = 0; v < graph.num_vertices(); ++v) {
    for (const std::uint32_t u : graph.neighbours(v)) {
      const Point3 along = difference(points[u], points[v]);
      geodesic.push_back(std::sqrt(product(along, along)));
      const bool convex = product(difference(normals[u], normals[v]), along) > 0.0;
      const double turn = std::max(1.0 - product(normals[u], normals[v]), 0.0);
      angular.push_back(triangles.empty() ? 0.0 : convex ? kConvex * turn : turn);
    }
  }
  normalise(geodesic);
  normalise(angular);
  for (std::size_t e = 0; e < geodesic.size(); ++e) {
    geodesic[e] = kGeodesic * geodesic[e] + (1.0 - kGeodesic) * angular[e];
  }
  return geodesic;
}

SurfaceSamples sample_surface(const Graph& graph, std::span<const double> lengths,
                              std::uint32_t count) {
  const std::uint32_t n = graph.num_vertices();
  SurfaceSamples samples;
  samples.nearest.assign(n, 0);
  std::vector<double> distance(n, kFar);
  std::uint32_t from = 0;
  for (;;) {
    shorten(graph, lengths, from, distance,
            [&](std::uint32_t v) { samples.nearest[v] = samples.count; });
    if (++samples.count == count) break;
    const auto farthest = std::max_element(distance.begin(), distance.end());
    if (*farthest <= 0.0) break;
    from = static_cast<std::uint32_t>(farthest - distance.begin());
  }
  const Cells cells = cells_of(graph, lengths, samples.nearest, distance, samples.count);
  samples.distance.assign(std::size_t{samples.count} * samples.count, kFar);
  for (std::uint32_t s = 0; s < samples.count; ++s) {
    const std::span<double> row =
        std::span(samples.distance).subspan(std::size_t{s} * samples.count, samples.count);
    shorten(cells.graph, cells.lengths, s, row, [](std::uint32_t /*v*/) {});
  }
  return samples;
}

}  // namespace rlpc
