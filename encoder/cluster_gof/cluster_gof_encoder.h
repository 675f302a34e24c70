// Analysis and quantisation of one GOF (Amjoun and Strasser 2007, 3; clause 8 backwards).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/cluster_gof/cluster_gof.h"
#include "common/cluster_gof/recon/cluster_recon.h"
#include "common/cluster_gof/recon/lcf.h"
#include "encoder/cluster_gof/clustering.h"
#include "encoder/cluster_gof/quantise_components.h"
#include "encoder/gof/gof_frames.h"
#include "encoder/gof/residual_choice.h"
#include "encoder/gof/sequence_mesh.h"
#include "encoder/math/principal_components.h"

namespace rlpc {

// What the analysis of a GOF depends on.
struct ClusterAnalysisSettings {
  bool world = false;               // analyse in world coordinates, not in frames of seeds
  std::uint32_t seed_step = 1;      // grid steps
  std::size_t max_components = 64;  // of one cluster
  double min_energy = 0.0;          // of a component worth a look, grid steps squared
};

// How the components of a GOF are chosen and quantised.
struct ClusterCodingSettings {
  enum class Steps : std::uint8_t {
    kEqualDistortion,  // every coded value adds the same error: one step for all
    kRanges,           // the paper's: 2^-qu and 2^-qc of each cluster's range of values
  };
  enum class Allocation : std::uint8_t { kFixed, kVectorBudget, kBitBudget, kSlope };

  Steps steps = Steps::kEqualDistortion;
  double step = 1.0;  // kEqualDistortion, grid steps
  int qu = 12;        // kRanges
  int qc = 12;
  Allocation allocation = Allocation::kSlope;
  std::uint32_t components = 0;  // per cluster: all but kSlope
  double dead_zone = kDeadZone;
};

struct ClusterAnalysis {
  std::vector<std::uint32_t> vertices;
  std::vector<Lcf> lcf;  // [num_frames]; empty: world coordinates
  PrincipalComponents pc;
  std::optional<SpatialPrediction> prediction;
};

struct ClusterGofAnalysis {
  ClusterGof gof;  // all but the components
  std::vector<ClusterAnalysis> clusters;
};

// Seed tracks in closed loop, and principal components in the recovered frames.
ClusterGofAnalysis analyse_cluster_gof(const SequenceMesh& mesh, const GofFrames& frames,
                                       const Clustering& clustering,
                                       const ClusterAnalysisSettings& settings);

// The GOF ready to be written, from the frames that were analysed.
ClusterGof code_cluster_gof(const GofFrames& frames, const ClusterGofAnalysis& analysis,
                            const ClusterCodingSettings& settings);

}  // namespace rlpc
