// Clusters vertices by their motion relative to seed triangles (Amjoun and Strasser 2007, 3.1
// and 3.2).
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
  std::vector<Seed> seeds;  // one per cluster; empty: one cluster without an LCF
  std::vector<std::uint16_t> cluster_of_vertex;  // [num_vertices]; also set for seed vertices
};

// Farthest-point seeds, and the motion of every vertex in the local coordinate frames of the
// seeds. The seeds of N clusters are the first N seeds of any larger number, so one object
// handles all N.
//
// The first seed vertex is the one farthest from the centre of frame 0, each further one the
// vertex farthest from all chosen so far. The seed is an incident triangle that is degenerate
// in no frame; in a point cloud, a triangle of the vertex and two of its nearest points.
// Vertices without such a triangle are skipped.
class MotionClusters {
 public:
  // Keeps references to the frames and triangles.
  MotionClusters(const GofFrames& frames, std::span<const Triangle> triangles,
                 int position_bits);

  // Assigns each vertex to that of the first `count` seeds in whose local coordinate frame it
  // moves least over the GOF; ties go to the lower index. There may be fewer seeds than
  // `count`, even none.
  Clustering clusters(std::uint32_t count);
  // As clusters(), then replaces each seed triangle by three distant vertices of its cluster
  // and assigns the vertices again. Noise rotates these frames less, so seeds can be coded more
  // coarsely.
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
  std::vector<double> distance_;  // squared, to the centre; later to the nearest seed
  std::vector<Seed> seeds_;
  std::vector<std::vector<double>> motion_;  // [seed][num_vertices]
};

}  // namespace rlpc
