// The data shared by all GOFs of a sequence, and the stages that each GOF passes through.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
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
#include "encoder/sequence/choices/gof_cuts.h"
#include "encoder/write/write_connectivity.h"

namespace rlpc {

inline constexpr std::uint32_t kDefaultGofFrames = 128;  // fixed: how far a seek decodes

// Maximum frames per GOF under the settings.
std::uint32_t longest_gof(const EncoderSettings& settings);

// The threads of the settings, or as many as the memory that they allow suffices for. Error:
// one may need more. kept_frames: number of frames whose analyses stay in memory; source_bytes:
// memory held by the source.
InputResult<std::uint32_t> check_memory(const EncoderSettings& settings,
                                        const SequenceHeader& header, std::uint32_t longest_gof,
                                        std::uint32_t kept_frames, std::uint64_t source_bytes);

// A source that several threads read from, one at a time.
struct SharedSource {
  FrameSource& source;
  std::mutex& reading;

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) const {
    const std::lock_guard lock(reading);
    return source.read_frame(frame, xyz);
  }
};

class SequenceCoding {
 public:
  // Keeps a reference to the settings. All vertex indices must be below num_vertices.
  SequenceCoding(const SequenceHeader& header, const EncoderSettings& settings,
                 std::span<const Triangle> triangles);
  SequenceCoding(const SequenceCoding&) = delete;
  SequenceCoding& operator=(const SequenceCoding&) = delete;

  const SequenceHeader& header() const { return header_; }
  const ConnectivityCode& connectivity() const { return connectivity_; }
  // The header may change in level and grid only. A new grid invalidates all frames and coders
  // made before.
  void set_header(const SequenceHeader& header) { header_ = header; }

  // The frames of a GOF, in decoded vertex order and grid units; span: frames of the source.
  // Errors: those of the source.
  InputResult<GofFrames> read_frames(FrameSource& source, const GofSpan& span) const;
  // Whether there is a further kind of GOF, for targets that the compared kinds miss.
  bool has_last_resort() const { return last_resort_ != nullptr; }
  // Keeps a reference to the frames. is_last_resort: use only that further kind.
  std::unique_ptr<GofCoder> make_coder(const GofFrames& frames, bool is_last_resort) const;
  // Decodes the GOF as a decoder would and adds its errors against the source to the metrics.
  // Those that have no frames yet follow the frame before the GOF. Returns the hash unit of the
  // GOF; empty if hashes are off. Errors: those of the source.
  InputResult<Bytes> measure(const SharedSource& source, const GofSpan& span,
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

// The units of a coded GOF as bytes of a stream.
Bytes write_gof_units(const EncodedGof& encoded);

}  // namespace rlpc
