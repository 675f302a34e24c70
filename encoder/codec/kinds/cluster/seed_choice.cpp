#include "encoder/codec/kinds/cluster/seed_choice.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/codec/kinds/cluster/recon/lcf.h"

namespace rlpc {
namespace {

constexpr std::size_t kNeighbours = 6;  // fixed: neighbours in a regular mesh

// Returns the indices of the triangles at each vertex.
std::vector<std::vector<std::uint32_t>> incident_triangles(
    std::uint32_t num_vertices, std::span<const Triangle> triangles) {
  std::vector<std::vector<std::uint32_t>> incident(num_vertices);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t v : triangles[t]) incident[v].push_back(t);
  }
  return incident;
}

// Returns the points nearest to vertex v in frame 0, without those that coincide with it.
std::vector<std::uint32_t> nearest_points(const SpanFrames& frames, std::uint32_t v) {
  std::vector<std::pair<double, std::uint32_t>> others;
  for (std::uint32_t u = 0; u < frames.num_vertices; ++u) {
    const double distance = distance2(frames.at(0, u), frames.at(0, v));
    if (distance > 0.0) others.emplace_back(distance, u);
  }
  const std::size_t count = std::min(kNeighbours, others.size());
  const auto end = others.begin() + static_cast<std::ptrdiff_t>(count);
  std::partial_sort(others.begin(), end, others.end());
  std::vector<std::uint32_t> nearest;
  for (auto it = others.begin(); it != end; ++it) nearest.push_back(it->second);
  return nearest;
}

// Puts the x axis along the longest edge in frame 0, where noise rotates it least.
Seed rotate_to_longest_edge(const SpanFrames& frames, const Triangle& t) {
  std::size_t best = 0;
  double longest = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = distance2(frames.at(0, t[k]), frames.at(0, t[(k + 1) % 3]));
    if (length > longest) {
      longest = length;
      best = k;
    }
  }
  return {t[best], t[(best + 1) % 3], t[(best + 2) % 3]};
}

}  // namespace

SeedChoice::SeedChoice(const SpanFrames& frames, std::span<const Triangle> triangles,
                       int position_bits, const SeedRules& rules)
    : frames_(frames),
      triangles_(triangles),
      position_bits_(position_bits),
      rules_(rules),
      incident_(incident_triangles(frames.num_vertices, triangles)) {}

// Returns the candidate seed triangles at a vertex.
std::vector<Triangle> SeedChoice::triangles_at(std::uint32_t v) const {
  std::vector<Triangle> found;
  for (const std::uint32_t t : incident_[v]) found.push_back(triangles_[t]);
  if (!triangles_.empty()) return found;
  const std::vector<std::uint32_t> near = nearest_points(frames_, v);
  for (std::size_t i = 0; i < near.size(); ++i) {
    for (std::size_t j = i + 1; j < near.size(); ++j) found.push_back({v, near[i], near[j]});
  }
  return found;
}

std::optional<Seed> SeedChoice::triangle_at(std::uint32_t v, const Suits& suits) const {
  double best_quality = 0.0;
  Triangle best{};
  for (const Triangle& t : triangles_at(v)) {
    if (suits && !suits(t)) continue;
    const double triangle_quality = quality(t);
    if (triangle_quality > best_quality) {
      best_quality = triangle_quality;
      best = t;
    }
    if (rules_.first && best_quality > 0.0) return best;
  }
  if (best_quality == 0.0) return std::nullopt;
  return rotate_to_longest_edge(frames_, best);
}

double SeedChoice::quality(const Seed& seed, double threshold) const {
  double worst = std::numeric_limits<double>::infinity();
  for (std::uint32_t f = 0; f < frames_.num_frames; ++f) {
    std::array<Vec3i, 3> p{};
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = nearest_position(frames_.at(f, seed[k]), position_bits_);
    std::array<double, 3> a{};
    std::array<double, 3> b{};
    for (std::size_t c = 0; c < 3; ++c) {
      a[c] = static_cast<double>(p[1][c] - p[0][c]);
      b[c] = static_cast<double>(p[2][c] - p[0][c]);
    }
    const double nx = a[1] * b[2] - a[2] * b[1];
    const double ny = a[2] * b[0] - a[0] * b[2];
    const double nz = a[0] * b[1] - a[1] * b[0];
    worst = std::min(worst, nx * nx + ny * ny + nz * nz);
    if (worst <= threshold) break;
  }
  return worst;
}

std::vector<double> SeedChoice::motion_in(const Seed& seed) const {
  const std::uint32_t n = frames_.num_vertices;
  std::vector<double> motion(n);
  std::vector<double> before(3 * std::size_t{n});
  for (std::uint32_t f = 0; f < frames_.num_frames; ++f) {
    std::array<Vec3i, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = nearest_position(frames_.at(f, seed[k]), position_bits_);
    }
    const LocalFrame local(make_lcf(p[0], p[1], p[2]));
    add_local_motion(rules_.sum, local, n, frames_.at(f, 0), before.data(), motion.data());
    if (f == 0) motion.assign(n, 0.0);  // there is no frame before the first
  }
  return motion;
}

Seed SeedChoice::spread(const Seed& seed, std::vector<std::uint32_t> vertices,
                        std::span<const double> motion) const {
  std::sort(vertices.begin(), vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
    return motion[a] != motion[b] ? motion[a] < motion[b] : a < b;
  });
  vertices.resize((vertices.size() + 1) / 2);
  if (vertices.size() < 3) return seed;
  const auto farthest_from = [&](std::uint32_t from) {
    return *std::max_element(vertices.begin(), vertices.end(),
                             [&](std::uint32_t a, std::uint32_t b) {
                               return distance2(frames_.at(0, a), frames_.at(0, from)) <
                                      distance2(frames_.at(0, b), frames_.at(0, from));
                             });
  };
  Seed found{};
  found[0] = farthest_from(seed[0]);
  found[1] = farthest_from(found[0]);
  double best = 0.0;
  for (const std::uint32_t v : vertices) {
    const double triangle_quality = quality({found[0], found[1], v}, best);
    if (triangle_quality <= best) continue;
    best = triangle_quality;
    found[2] = v;
  }
  return best > 0.0 ? found : seed;
}

}  // namespace rlpc
