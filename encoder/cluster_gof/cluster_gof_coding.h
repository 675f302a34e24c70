// One cluster GOF at the quantisers of the settings.
#pragma once

#include <cstdint>

#include "encoder/cluster_gof/cluster_gof_encoder.h"
#include "encoder/cluster_gof/clustering.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/gof/sequence_mesh.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// How a GOF is cut into clusters.
struct ClusterChoice {
  std::uint32_t clusters;
  bool world;
};

// Steps are in grid steps; they count where the settings have no quantisers of their own (qu,
// qc, qdelta).
class ClusterGofCoding {
 public:
  // All are kept by reference.
  ClusterGofCoding(const SequenceMesh& mesh, const EncoderSettings& settings,
                   const GofFrames& frames)
      : mesh_(mesh), settings_(settings), frames_(frames) {}

  const EncoderSettings& settings() const { return settings_; }
  const GofFrames& frames() const { return frames_; }
  // No clusters yet.
  MotionClusters motion() const;
  Clustering cluster(MotionClusters& motion, std::uint32_t count) const;
  ClusterGofAnalysis analyse(double step, bool world, const Clustering& clustering) const;
  EncodedGof encode(double step, const ClusterGofAnalysis& analysis) const;
  // All of it for one choice.
  EncodedGof encode(double step, const ClusterChoice& choice, MotionClusters& motion) const;

 private:
  ClusterAnalysisSettings analysis_settings(double step, bool world) const;
  ClusterCodingSettings coding_settings(double step) const;

  const SequenceMesh& mesh_;
  const EncoderSettings& settings_;
  const GofFrames& frames_;
};

}  // namespace rlpc
