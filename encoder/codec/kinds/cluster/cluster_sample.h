// Estimates from a part of the mesh what a cluster GOF takes, and chooses its clusters.
#pragma once

#include <cstdint>

#include "common/codec/mesh/topology.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/kinds/cluster/cluster_gof_coding.h"
#include "encoder/codec/partition/mesh_sample.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/sequence_mesh.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Codes all frames of regions of the mesh, with clusters of several sizes.
class ClusterSample {
 public:
  // Keeps a reference to the settings.
  ClusterSample(const SequenceMesh& mesh, const EncoderSettings& settings,
                const SpanFrames& frames);
  ClusterSample(const ClusterSample&) = delete;
  ClusterSample& operator=(const ClusterSample&) = delete;

  struct Estimate {
    ClusterChoice choice;  // of the whole mesh: clusters as large as the best of the sample
    SpanCost cost;         // of the whole mesh
  };
  // Returns the cheapest of several choices; of fewer, if they cost far more than the rival.
  // step: as in SpanCoder::encode().
  Estimate cheapest(double step, const SpanCost& rival) const;

 private:
  const std::uint32_t num_vertices_;  // of the whole mesh
  const MeshSample sample_;
  const SpanFrames frames_;
  const SequenceHeader header_;
  const Topology topology_;
  const SequenceMesh mesh_;
  const ClusterGofCoding coding_;
};

}  // namespace rlpc
