// Analysis and quantisation of one cluster GOF (Amjoun and Strasser 2007, 3; inverse of 8.4 to
// 8.6).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/cluster/recon/cluster_recon.h"
#include "common/codec/kinds/cluster/recon/lcf.h"
#include "encoder/codec/kinds/cluster/clustering.h"
#include "encoder/codec/kinds/cluster/quantise_components.h"
#include "encoder/codec/math/principal_components.h"
#include "encoder/codec/spans/residual_choice.h"
#include "encoder/codec/spans/sequence_mesh.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Parameters of the analysis of a GOF.
struct ClusterAnalysisSettings {
  bool world = false;               // world coordinates instead of local coordinate frames
  std::uint32_t seed_step = 1;      // grid steps
  std::size_t max_components = 64;  // per cluster
  double min_energy = 0.0;          // components below are dropped; squared grid steps
};

// How the components of a GOF are chosen and quantised.
struct ClusterCodingSettings {
  enum class Steps : std::uint8_t {
    kEqualDistortion,  // one step for all values: each adds the same error
    kRanges,           // 2^-qu and 2^-qc of each cluster's range of values, as in the paper
  };
  enum class Allocation : std::uint8_t { kFixed, kVectorBudget, kBitBudget, kSlope };

  Steps steps = Steps::kEqualDistortion;
  double step = 1.0;  // kEqualDistortion, grid steps
  int qu = 12;        // kRanges
  int qc = 12;
  Allocation allocation = Allocation::kSlope;
  std::uint32_t components = 0;  // per cluster; not used by kSlope
  double dead_zone = kDeadZone;
};

struct ClusterAnalysis {
  std::vector<std::uint32_t> vertices;
  std::vector<Lcf> lcf;  // [num_frames]; empty: world coordinates
  PrincipalComponents pc;
  std::optional<SpatialPrediction> prediction;
};

struct ClusterGofAnalysis {
  ClusterGof gof;  // complete except for the components
  std::vector<ClusterAnalysis> clusters;
};

// Codes the seed tracks in closed loop, and computes the principal components in the local
// coordinate frames that a decoder recovers from them.
ClusterGofAnalysis analyse_cluster_gof(const SequenceMesh& mesh, const SpanFrames& frames,
                                       const Clustering& clustering,
                                       const ClusterAnalysisSettings& settings);

// Quantises the components and completes the GOF. frames: those passed to the analysis.
ClusterGof code_cluster_gof(const SpanFrames& frames, const ClusterGofAnalysis& analysis,
                            const ClusterCodingSettings& settings);

}  // namespace rlpc
