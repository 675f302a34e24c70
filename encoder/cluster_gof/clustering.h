// Clusters by motion in seed-triangle frames (Amjoun and Strasser 2007, 3.1 and 3.2).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/cluster_gof/recon/lcf.h"
#include "common/mesh/mesh.h"
#include "encoder/gof/gof_frames.h"

namespace rlpc {

using Seed = std::array<std::uint32_t, 3>;  // p1, p2, p3 of a seed triangle

struct Clustering {
  std::vector<Seed> seeds;  // one per cluster; empty: one cluster without a frame
  std::vector<std::uint16_t> cluster_of_vertex;  // [num_vertices]; also set for seed vertices
};

// Far-distance seeds, and the motion of every vertex in their frames. The seeds of N clusters
// are the first N of those of more clusters, so one object serves every N.
//
// Seeds: the vertex farthest from the centre of frame 0, then each time the vertex farthest
// from those chosen. Each brings an incident triangle that is degenerate in no frame, in a
// point cloud one with two of its nearest points; vertices without one are passed over.
class MotionClusters {
 public:
  // Everything is kept by reference.
  MotionClusters(const GofFrames& frames, std::span<const Triangle> triangles,
                 int position_bits);

  // Assigns each vertex to the one of the first `count` seeds in whose frame it moves least
  // over the GOF; ties go to the lower index. Fewer seeds than asked for may exist, even none.
  Clustering clusters(std::uint32_t count);
  // The same clusters with each seed triangle replaced by three far-apart vertices of its
  // cluster: noise then turns the frame less, and seeds can be coded coarser. Vertices are
  // assigned afresh.
  Clustering spread_clusters(std::uint32_t count);

 private:
  std::vector<Triangle> triangles_at(std::uint32_t v) const;
  bool add_seed();
  std::vector<double> motion_in(const Seed& seed) const;
  Seed spread_seed(const Clustering& clustering, std::size_t i) const;
  static void assign(Clustering& clustering, std::size_t i, const std::vector<double>& motion,
                     std::vector<double>& least);

  const GofFrames& frames_;
  std::span<const Triangle> triangles_;
  int position_bits_;
  std::vector<std::vector<std::uint32_t>> incident_;
  std::vector<double> distance_;  // to the centre at first, then to the nearest seed
  std::vector<Seed> seeds_;
  std::vector<std::vector<double>> motion_;  // [seed][num_vertices]
};

}  // namespace rlpc
