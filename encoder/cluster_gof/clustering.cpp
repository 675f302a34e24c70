#include "encoder/cluster_gof/clustering.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/cluster_gof/local_motion.h"

namespace rlpc {
namespace {

constexpr std::size_t kNeighbours = 6;  // fixed: of a vertex of a regular mesh

double distance2(const double* a, const double* b) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

// How stable a local coordinate frame on the triangle is: the minimum over the GOF of the
// square of its doubled area; 0 if it is degenerate in any frame. Stops early once the minimum
// is at most `threshold`.
double triangle_quality(const GofFrames& frames, const Seed& t, int position_bits,
                        double threshold = 0.0) {
  double worst = std::numeric_limits<double>::infinity();
  for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
    std::array<Vec3i, 3> p{};
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = nearest_position(frames.at(f, t[k]), position_bits);
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

// Indices of the triangles at each vertex.
std::vector<std::vector<std::uint32_t>> incident_triangles(
    std::uint32_t num_vertices, std::span<const Triangle> triangles) {
  std::vector<std::vector<std::uint32_t>> incident(num_vertices);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t v : triangles[t]) incident[v].push_back(t);
  }
  return incident;
}

// The points nearest to vertex v in frame 0, without those that coincide with it.
std::vector<std::uint32_t> nearest_points(const GofFrames& frames, std::uint32_t v) {
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
Seed rotate_to_longest_edge(const GofFrames& frames, const Triangle& t) {
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

MotionClusters::MotionClusters(const GofFrames& frames, std::span<const Triangle> triangles,
                               int position_bits)
    : frames_(frames),
      triangles_(triangles),
      position_bits_(position_bits),
      incident_(incident_triangles(frames.num_vertices, triangles)),
      distance_(frames.num_vertices) {
  const std::uint32_t n = frames.num_vertices;
  std::array<double, 3> centre{};
  for (std::uint32_t v = 0; v < n; ++v) {
    for (std::size_t c = 0; c < 3; ++c) centre[c] += frames.at(0, v)[c];
  }
  for (double& c : centre) c /= n;
  for (std::uint32_t v = 0; v < n; ++v) {  // an isolated vertex of a mesh cannot be a seed
    const bool isolated = incident_[v].empty() && !triangles_.empty();
    distance_[v] = isolated ? -1.0 : distance2(frames.at(0, v), centre.data());
  }
}

// The candidate seed triangles at a vertex.
std::vector<Triangle> MotionClusters::triangles_at(std::uint32_t v) const {
  std::vector<Triangle> found;
  for (const std::uint32_t t : incident_[v]) found.push_back(triangles_[t]);
  if (!triangles_.empty()) return found;
  const std::vector<std::uint32_t> near = nearest_points(frames_, v);
  for (std::size_t i = 0; i < near.size(); ++i) {
    for (std::size_t j = i + 1; j < near.size(); ++j) found.push_back({v, near[i], near[j]});
  }
  return found;
}

// False once every vertex is a seed or was skipped.
bool MotionClusters::add_seed() {
  for (;;) {
    const auto farthest = std::max_element(distance_.begin(), distance_.end());
    if (*farthest < 0.0) return false;
    const auto v = static_cast<std::uint32_t>(farthest - distance_.begin());
    *farthest = -1.0;
    double best_quality = 0.0;
    Triangle best{};
    for (const Triangle& t : triangles_at(v)) {
      const double quality = triangle_quality(frames_, t, position_bits_);
      if (quality > best_quality) {
        best_quality = quality;
        best = t;
      }
    }
    if (best_quality == 0.0) continue;
    if (seeds_.empty()) {
      for (double& d : distance_) d = d < 0.0 ? d : std::numeric_limits<double>::infinity();
    }
    for (std::uint32_t u = 0; u < frames_.num_vertices; ++u) {
      distance_[u] = std::min(distance_[u], distance2(frames_.at(0, u), frames_.at(0, v)));
    }
    seeds_.push_back(rotate_to_longest_edge(frames_, best));
    return true;
  }
}

// Total motion of every vertex between adjacent frames, in the coordinates of a seed (3.2).
std::vector<double> MotionClusters::motion_in(const Seed& seed) const {
  const std::uint32_t n = frames_.num_vertices;
  std::vector<double> motion(n);
  std::vector<double> before(3 * std::size_t{n});
  for (std::uint32_t f = 0; f < frames_.num_frames; ++f) {
    std::array<Vec3i, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = nearest_position(frames_.at(f, seed[k]), position_bits_);
    }
    const LocalFrame local(make_lcf(p[0], p[1], p[2]));
    add_local_motion(local, n, frames_.at(f, 0), before.data(), motion.data());
    if (f == 0) motion.assign(n, 0.0);  // there is no frame before the first
  }
  return motion;
}

Clustering MotionClusters::clusters(std::uint32_t count) {
  const std::size_t before = seeds_.size();
  while (seeds_.size() < count && add_seed()) {
  }
  motion_.resize(seeds_.size());
  for_each(seeds_.size() - before,
           [&](std::size_t i) { motion_[before + i] = motion_in(seeds_[before + i]); });
  const std::size_t found = std::min<std::size_t>(seeds_.size(), count);
  Clustering clustering;
  clustering.seeds.assign(seeds_.begin(), seeds_.begin() + static_cast<std::ptrdiff_t>(found));
  clustering.cluster_of_vertex.assign(frames_.num_vertices, 0);
  std::vector<double> least(frames_.num_vertices, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < found; ++i) assign(clustering, i, motion_[i], least);
  return clustering;
}

// Assigns to cluster i the vertices that move less in its coordinates than in those of clusters
// 0 to i - 1.
void MotionClusters::assign(Clustering& clustering, std::size_t i,
                            const std::vector<double>& motion, std::vector<double>& least) {
  for (std::uint32_t v = 0; v < motion.size(); ++v) {
    if (motion[v] >= least[v]) continue;
    least[v] = motion[v];
    clustering.cluster_of_vertex[v] = static_cast<std::uint16_t>(i);
  }
}

Clustering MotionClusters::spread_clusters(std::uint32_t count) {
  Clustering clustering = clusters(count);
  constexpr std::size_t kTogether = 16;  // fixed: memory
  const Clustering before = clustering;
  std::vector<double> least(frames_.num_vertices, std::numeric_limits<double>::infinity());
  for (std::size_t first = 0; first < before.seeds.size(); first += kTogether) {
    std::vector<std::vector<double>> motion(std::min(kTogether, before.seeds.size() - first));
    for_each(motion.size(), [&](std::size_t i) {
      clustering.seeds[first + i] = spread_seed(before, first + i);
      motion[i] = motion_in(clustering.seeds[first + i]);
    });
    for (std::size_t i = 0; i < motion.size(); ++i) {
      assign(clustering, first + i, motion[i], least);
    }
  }
  return clustering;
}

// Three distant vertices of a cluster, from the half that moves least in the coordinates of the
// seed.
Seed MotionClusters::spread_seed(const Clustering& clustering, std::size_t i) const {
  std::vector<std::uint32_t> calm;
  for (std::uint32_t v = 0; v < frames_.num_vertices; ++v) {
    if (clustering.cluster_of_vertex[v] == i) calm.push_back(v);
  }
  std::sort(calm.begin(), calm.end(), [&](std::uint32_t a, std::uint32_t b) {
    return motion_[i][a] != motion_[i][b] ? motion_[i][a] < motion_[i][b] : a < b;
  });
  calm.resize((calm.size() + 1) / 2);
  if (calm.size() < 3) return clustering.seeds[i];
  const auto farthest_from = [&](std::uint32_t from) {
    return *std::max_element(calm.begin(), calm.end(), [&](std::uint32_t a, std::uint32_t b) {
      return distance2(frames_.at(0, a), frames_.at(0, from)) <
             distance2(frames_.at(0, b), frames_.at(0, from));
    });
  };
  Seed seed{};
  seed[0] = farthest_from(clustering.seeds[i][0]);
  seed[1] = farthest_from(seed[0]);
  double best = 0.0;
  for (const std::uint32_t v : calm) {
    const double quality =
        triangle_quality(frames_, {seed[0], seed[1], v}, position_bits_, best);
    if (quality <= best) continue;
    best = quality;
    seed[2] = v;
  }
  return best > 0.0 ? seed : clustering.seeds[i];
}

}  // namespace rlpc
