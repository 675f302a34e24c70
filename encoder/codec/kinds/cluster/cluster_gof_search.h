// Chooses the clusters of one GOF by Lagrangian cost.
#pragma once

#include <cstdint>

#include "encoder/codec/kinds/cluster/cluster_gof_coding.h"

namespace rlpc {

struct FoundClusters {
  ClusterChoice choice{};
  Clustering clustering;
};

// Returns the clusters with the lowest cost at a step (grid steps), among those that the
// settings allow.
FoundClusters search_clusters(const ClusterGofCoding& coding, double step);

// Searches from a choice that is nearly right: the number of clusters about that number, and
// one cluster in world coordinates.
FoundClusters search_clusters_near(const ClusterGofCoding& coding, double step,
                                   const ClusterChoice& choice);

// Returns a number of clusters that suits many GOFs, for use without a search.
std::uint32_t usual_clusters(std::uint32_t num_vertices);

}  // namespace rlpc
