// What the GOFs of a sequence have in common, and the steps that each of them goes through.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/mesh/topology.h"
#include "common/mesh/vertex_layers.h"
#include "common/syntax/sequence_header.h"
#include "common/syntax/write_units.h"
#include "encoder/cluster_gof/cluster_gof_search.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_kind_search.h"
#include "encoder/metrics/metrics.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/sequence/gof_cuts.h"
#include "encoder/sequence/target_search.h"
#include "encoder/write/write_connectivity.h"

namespace rlpc {

inline constexpr std::uint32_t kDefaultGofFrames = 128;

// The longest GOF that the settings allow.
std::uint32_t longest_gof(const EncoderSettings& settings);

// rms_spread: of a coordinate about the mean of its frame, units, over the frames that the
// target is for.
TargetSearch search_for(const EncoderSettings& settings, const SequenceHeader& header,
                        double rms_spread);

// The choices of a search that hold for later coders of the same GOF.
struct GofMemory {
  std::optional<ClusterChoice> clusters;  // of the Baseline profile
  GofKindChoice main;                     // of the Main profile
};

class SequenceCoding {
 public:
  // Keeps a reference to the settings. Every index of the triangles is below num_vertices.
  SequenceCoding(const SequenceHeader& header, const EncoderSettings& settings,
                 std::span<const Triangle> triangles);
  SequenceCoding(const SequenceCoding&) = delete;
  SequenceCoding& operator=(const SequenceCoding&) = delete;

  const SequenceHeader& header() const { return header_; }
  const ConnectivityCode& connectivity() const { return connectivity_; }
  // The same with another level, or with another grid: frames and coders from before are then
  // of no use.
  void set_header(const SequenceHeader& header);

  // The frames of a GOF, in decoded vertex order and grid units. Error: that of the source.
  InputResult<GofFrames> read_frames(FrameSource& source, const GofSpan& span) const;
  // For the GOF that begins with first_frame of the sequence. Keeps references to frames and
  // memory.
  std::unique_ptr<GofCoder> make_coder(const GofFrames& frames, std::uint32_t first_frame,
                                       GofMemory& memory) const;
  // Decodes what was written, as a decoder would, and compares with the input. Returns the hash
  // unit of the GOF, empty if there is to be none. Error: that of the source.
  InputResult<Bytes> measure(FrameSource& source, const GofSpan& span,
                             const DecodeFrame& decode, MetricsAccumulator& metrics) const;

 private:
  SequenceHeader header_;
  const EncoderSettings& settings_;
  ConnectivityCode connectivity_;
  Topology topology_;
  ClusterContext context_;
  VertexLayers layers_;  // of the Main profile
  std::optional<SkinnedContext> bone_context_;
};

// The units of a coded GOF, as they stand in a stream.
Bytes write_gof_units(const EncodedGof& encoded);

}  // namespace rlpc
