// What the GOFs of a sequence have in common, and the steps that each of them goes through.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/mesh/topology.h"
#include "common/syntax/sequence_header.h"
#include "common/syntax/write_units.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_kind.h"
#include "encoder/gof/sequence_mesh.h"
#include "encoder/metrics/metrics.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/sequence/gof_cuts.h"
#include "encoder/write/write_connectivity.h"

namespace rlpc {

inline constexpr std::uint32_t kDefaultGofFrames = 128;  // fixed: how far a seek decodes

// The longest GOF that the settings allow.
std::uint32_t longest_gof(const EncoderSettings& settings);

// Error: the settings do not allow the memory that encoding takes. kept_frames: those whose
// analyses stay in memory; source_bytes: what the source keeps.
std::optional<InputError> check_memory(const EncoderSettings& settings,
                                       const SequenceHeader& header, std::uint32_t longest_gof,
                                       std::uint32_t kept_frames, std::uint64_t source_bytes);

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
  void set_header(const SequenceHeader& header) { header_ = header; }

  // The frames of a GOF, in decoded vertex order and grid units; span.first is that of the
  // source. Error: that of the source.
  InputResult<GofFrames> read_frames(FrameSource& source, const GofSpan& span) const;
  // Whether there is a kind of GOF beside those compared, for targets that these fail.
  bool has_last_resort() const { return last_resort_ != nullptr; }
  // Keeps a reference to the frames. is_last_resort: of that kind alone.
  std::unique_ptr<GofCoder> make_coder(const GofFrames& frames, bool is_last_resort) const;
  // Decodes what was written, as a decoder would, and compares with the input. Returns the hash
  // unit of the GOF, empty if there is to be none. Error: that of the source.
  InputResult<Bytes> measure(FrameSource& source, const GofSpan& span,
                             const DecodeFrame& decode, MetricsAccumulator& metrics) const;

 private:
  SequenceHeader header_;
  const EncoderSettings& settings_;
  ConnectivityCode connectivity_;
  Topology topology_;
  SequenceMesh mesh_;
  GofKinds kinds_;
  std::unique_ptr<GofEncoder> last_resort_;
};

// The units of a coded GOF, as they stand in a stream.
Bytes write_gof_units(const EncodedGof& encoded);

}  // namespace rlpc
