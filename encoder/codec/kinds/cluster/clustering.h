// Clusters vertices by their motion relative to seed triangles (Amjoun and Strasser 2007, 3.1
// and 3.2).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/kinds/cluster/seed_choice.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

struct Clustering {
  // Seeds of the first clusters; later clusters have no LCF. There is at least one cluster.
  std::vector<Seed> seeds;
  std::vector<std::uint16_t> cluster_of_vertex;  // [num_vertices]; also set for seed vertices
  std::size_t without_lcf = 0;                   // clusters that have no seed

  std::size_t num_clusters() const {
    return std::max<std::size_t>(seeds.size() + without_lcf, 1);
  }
};

std::vector<std::uint32_t> vertices_of(const Clustering& clustering, std::size_t cluster);

// Clusters of the frames of a GOF, for any number of clusters.
class ClusterMaker {
 public:
  virtual ~ClusterMaker() = default;
  // Returns at most `count` clusters, with seeds that are triangles.
  virtual Clustering clusters(std::uint32_t count) = 0;
  // Like clusters(), with seeds of distant vertices of each cluster. Noise rotates these frames
  // less, so seeds can be coded more coarsely.
  virtual Clustering spread_clusters(std::uint32_t count) = 0;
};

// Farthest-point seeds, and the motion of every vertex in the local coordinate frames of the
// seeds. The seeds of N clusters are the first N seeds of any larger number, so one object
// handles all N.
//
// The first seed vertex is the one farthest from the centre of frame 0, each further one the
// vertex farthest from all chosen so far. The seed is an incident triangle that is degenerate
// in no frame; in a point cloud, a triangle of the vertex and two of its nearest points.
// Vertices without such a triangle are skipped.
class MotionClusters : public ClusterMaker {
 public:
  // Keeps references to the frames and triangles.
  MotionClusters(const SpanFrames& frames, std::span<const Triangle> triangles,
                 int position_bits, const SeedRules& rules = {});

  // Assigns each vertex to that of the first `count` seeds in whose local coordinate frame it
  // moves least over the GOF; ties go to the lower index. There may be fewer seeds than
  // `count`, even none.
  Clustering clusters(std::uint32_t count) override;
  // Calls clusters(), then replaces each seed triangle by three distant vertices of its cluster
  // and assigns the vertices again.
  Clustering spread_clusters(std::uint32_t count) override;

 private:
  bool add_seed();
  static void assign(Clustering& clustering, std::size_t i, const std::vector<double>& motion,
                     std::vector<double>& min_motion);

  const SpanFrames& frames_;
  SeedChoice choice_;
  std::vector<double> distance_;  // squared, to the centre; later to the nearest seed
  std::vector<Seed> seeds_;
  std::vector<std::vector<double>> motion_;  // [seed][num_vertices]
};

}  // namespace rlpc
