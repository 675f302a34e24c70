// Chooses between variants of the RLPCA paper's method, which leaves some choices open: the
// triangle at a seed, and whether the distances that vertices move are squared. Distant
// vertices instead of a triangle are another variant: noise turns their frames less.
#pragma once

#include <span>

#include "encoder/codec/kinds/cluster/cluster_gof_coding.h"
#include "encoder/codec/kinds/cluster/clustering.h"

namespace rlpc {

struct FoundVariant {
  ClusterChoice choice{};
  Clustering clustering;
};

// Whether the settings leave more than one variant. Only with qu and qc.
bool has_variants(const EncoderSettings& settings);

// Encodes every variant that the settings leave open, with each of the choices, and returns the
// one of least cost: squared error and bits, weighted as the last component of each cluster
// trades them. Its error is at most that of the first choice with the paper's literal method:
// the first triangle, and distances that are not squared. Ties go to the earlier one. choices:
// at least one.
FoundVariant search_variants(const ClusterGofCoding& coding, double step,
                             std::span<const ClusterChoice> choices);

}  // namespace rlpc
