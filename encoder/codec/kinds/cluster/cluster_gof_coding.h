// The stages that encode one cluster GOF, with quantisers taken from the settings.
#pragma once

#include <cstdint>
#include <memory>

#include "encoder/codec/kinds/cluster/cluster_gof_encoder.h"
#include "encoder/codec/kinds/cluster/clustering.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/sequence_mesh.h"
#include "encoder/codec/spans/span_coder.h"

namespace rlpc {

// How a GOF is divided into clusters.
struct ClusterChoice {
  std::uint32_t clusters = 1;
  bool world = false;  // analyse in world coordinates instead of local coordinate frames
};

// `step` is in grid steps everywhere. It is ignored if the settings give explicit quantisers
// (qu, qc, qdelta).
class ClusterGofCoding {
 public:
  // Keeps references to all arguments.
  ClusterGofCoding(const SequenceMesh& mesh, const EncoderSettings& settings,
                   const SpanFrames& frames)
      : mesh_(mesh), settings_(settings), frames_(frames) {}

  const SequenceMesh& mesh() const { return mesh_; }
  const EncoderSettings& settings() const { return settings_; }
  const SpanFrames& frames() const { return frames_; }
  // Returns what divides the frames into clusters, as the settings say.
  std::unique_ptr<ClusterMaker> cluster_maker() const;
  Clustering cluster(ClusterMaker& maker, std::uint32_t count) const;
  ClusterGofAnalysis analyse(double step, bool world, const Clustering& clustering) const;
  EncodedSpan encode(double step, const ClusterGofAnalysis& analysis) const;
  // Clusters, analyses and encodes.
  EncodedSpan encode(double step, const ClusterChoice& choice, ClusterMaker& maker) const;

 private:
  ClusterAnalysisSettings analysis_settings(double step, bool world) const;
  ClusterCodingSettings coding_settings(double step) const;

  const SequenceMesh& mesh_;
  const EncoderSettings& settings_;
  const SpanFrames& frames_;
};

}  // namespace rlpc
