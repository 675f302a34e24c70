// The choice of clusters for one GOF, by Lagrangian cost on coded bits.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/cluster_gof/cluster_gof_encoder.h"
#include "encoder/cluster_gof/clustering.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// How a GOF is cut into clusters.
struct ClusterChoice {
  std::uint32_t clusters;
  bool world;
};

// Encodes one GOF at varying steps. The last analysis is kept, and serves again for its step.
class ClusterGofSearch : public GofCoder {
 public:
  // All but the number are kept by reference. choice: that of an earlier search of the same
  // GOF, or none; the first encode() makes it.
  ClusterGofSearch(const ClusterContext& context, const GofFrames& frames,
                   std::uint32_t first_frame, const EncoderSettings& settings,
                   std::optional<ClusterChoice>& choice);

  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return true; }
  // The GOF at the settings' own quantisers (qu, qc, qdelta) or, without them, with the
  // quantiser step that is given, in grid steps.
  // analysis_step: the step that the analysis is made for, near it.
  EncodedGof encode(double step, double analysis_step) override;
  // The same with clusters that are given, for that step; nothing is kept.
  EncodedGof encode_once(double step, const ClusterChoice& choice);

 private:
  struct Cached {
    double step;  // that it was made for
    ClusterGofAnalysis analysis;
  };

  ClusterAnalysisSettings analysis_settings(double step, const ClusterChoice& choice) const;
  ClusterCodingSettings coding_settings(double step) const;
  Clustering cluster(const ClusterChoice& choice);
  ClusterGofAnalysis analysis_for(double step, const ClusterChoice& choice,
                                  const Clustering& clustering) const;
  double cost(double step, const ClusterChoice& choice);
  ClusterChoice choose(double step);
  std::uint32_t choose_count(double step, bool world);

  const ClusterContext& context_;
  const GofFrames& frames_;
  std::uint32_t first_frame_;
  const EncoderSettings& settings_;
  const BaselineTools& tools_;
  std::optional<ClusterChoice>& choice_;
  std::optional<MotionClusters> motion_;  // while clusters are looked for,
  std::optional<Clustering> clustering_;  // of which these were chosen
  std::optional<Cached> cached_;
};

}  // namespace rlpc
