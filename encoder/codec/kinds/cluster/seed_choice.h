// Chooses the vertices that define a cluster's local coordinate frame.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/kinds/cluster/local_motion.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

using Seed = std::array<std::uint32_t, 3>;  // p1, p2, p3 of a seed triangle

// Returns the squared distance of two positions.
inline double distance2(const double* a, const double* b) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

// Kind of seeds that SeedChoice makes, and measure of motion.
struct SeedRules {
  bool first = false;  // the first triangle at a vertex as it is, instead of the best
  DistanceSum sum = DistanceSum::kSquared;
};

class SeedChoice {
 public:
  using Suits = std::function<bool(const Triangle&)>;

  // Keeps references to the frames and triangles.
  SeedChoice(const SpanFrames& frames, std::span<const Triangle> triangles, int position_bits,
             const SeedRules& rules = {});

  // Returns the best triangle at a vertex that is degenerate in no frame, turned so that noise
  // rotates its frame least; in a point cloud, a triangle of the vertex and two of its nearest
  // points. With SeedRules::first: the first that is degenerate in no frame. suits: the
  // triangles allowed; empty: all.
  std::optional<Seed> triangle_at(std::uint32_t v, const Suits& suits = {}) const;
  // Returns the stability of a local coordinate frame on the seed: the minimum over the GOF of
  // the square of its doubled area; 0 if it is degenerate in any frame. Stops early once the
  // minimum is at most `threshold`.
  double quality(const Seed& seed, double threshold = 0.0) const;
  // Returns the total motion of every vertex between frames, in the coordinates of a seed
  // (3.2).
  std::vector<double> motion_in(const Seed& seed) const;
  // Returns three distant vertices of a cluster, from the half that moves least in the
  // coordinates of its seed; that seed if they have no stable frame.
  //
  //   motion  motion_in(seed)
  Seed spread(const Seed& seed, std::vector<std::uint32_t> vertices,
              std::span<const double> motion) const;
  // Whether a vertex of a mesh has no triangle, and therefore no seed.
  bool is_isolated(std::uint32_t v) const {
    return incident_[v].empty() && !triangles_.empty();
  }

 private:
  std::vector<Triangle> triangles_at(std::uint32_t v) const;

  const SpanFrames& frames_;
  std::span<const Triangle> triangles_;
  int position_bits_;
  SeedRules rules_;
  std::vector<std::vector<std::uint32_t>> incident_;  // triangles at each vertex
};

}  // namespace rlpc
