// The choice of clusters for one GOF, by Lagrangian cost.
#pragma once

#include <cstdint>

#include "encoder/cluster_gof/cluster_gof_coding.h"

namespace rlpc {

struct FoundClusters {
  ClusterChoice choice;
  Clustering clustering;
};

// The clusters that cost least at a step, of those that the settings allow.
FoundClusters search_clusters(const ClusterGofCoding& coding, double step);

}  // namespace rlpc
