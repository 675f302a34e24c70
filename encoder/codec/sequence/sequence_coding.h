// The data shared by all GOFs of a sequence, and the stages that each GOF passes through.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/mesh/topology.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/codec/syntax/write_units.h"
#include "encoder/codec/attributes/normal_error.h"
#include "encoder/codec/metrics/metrics.h"
#include "encoder/codec/sequence/choices/gof_cuts.h"
#include "encoder/codec/sequence/stream_assembly.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/kind_encoder.h"
#include "encoder/codec/spans/sequence_mesh.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/write/write_connectivity.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// A source that several threads read from, one at a time.
struct SharedSource {
  FrameSource& source;
  std::mutex& reading;

  // Reads the numbers of the input, which errors are measured against.
  std::optional<InputError> read_frame(std::uint32_t frame, std::span<double> xyz) const {
    const std::lock_guard lock(reading);
    return source.read_exact(frame, xyz);
  }
};

class SequenceCoding {
 public:
  // Keeps a reference to the settings. All vertex indices must be below num_vertices. The
  // profile of the settings decides which tools are tried; the profile of the header, which
  // includes it, decides how they are written.
  SequenceCoding(const SequenceHeader& header, const EncoderSettings& settings,
                 std::span<const Triangle> triangles);
  SequenceCoding(const SequenceCoding&) = delete;
  SequenceCoding& operator=(const SequenceCoding&) = delete;

  const SequenceHeader& header() const { return header_; }
  const ConnectivityCode& connectivity() const { return connectivity_; }
  const SequenceMesh& mesh() const { return mesh_; }
  // Returns the triangles of the input whose vertex normals are measured; empty unless the
  // target bounds them.
  std::span<const Triangle> normal_triangles() const { return normal_triangles_; }
  // Changes the header, but only level and grid. A new grid invalidates all frames and coders
  // made before.
  void set_header(const SequenceHeader& header) { header_ = header; }

  // Returns frames of the source, as positions on the grid in decoded order.
  InputResult<std::vector<DecodedFrame>> nearest_frames(
      FrameSource& source, std::span<const std::uint32_t> numbers) const;
  // Returns the frames of a span, in decoded vertex order and grid units, and how the bones of
  // the source move them. span: frames of the source. Errors: errors of the source.
  InputResult<SpanFrames> read_frames(FrameSource& source, const FrameRange& span) const;
  // Whether there is a further kind of GOF, for targets that the compared kinds miss.
  bool has_last_resort() const { return last_resort_ != nullptr; }
  // Keeps a reference to the frames. is_last_resort: use only that further kind.
  std::unique_ptr<SpanCoder> make_coder(const SpanFrames& frames, bool is_last_resort) const;
  // Whether spans can use shared rigs of earlier ones.
  bool has_rigs() const { return settings_.profile == Profile::kHigh; }
  // Calls KindEncoder::encode_with() of the kind that has shared rigs.
  std::optional<EncodedSpan> encode_with(const KeptRig& rig, const SpanFrames& frames,
                                         double step, double max_cost) const;
  // Whether the target is a maximum error.
  bool has_largest_error() const { return settings_.target.kind == Target::kMaxError; }
  // Decodes the span as a decoder would and adds its errors against the source to the metrics;
  // if these have no frames so far, they follow the frame before the span. Returns the hash
  // unit of each GOF; empty if hashes are off. Errors: errors of the source.
  InputResult<std::vector<Bytes>> measure(const SharedSource& source, const FrameRange& span,
                                          const DecodeFrame& decode,
                                          MetricsAccumulator& metrics) const;

 private:
  struct MeasuredFrame {
    std::vector<std::int32_t> positions;
    std::vector<double> original;
    MetricsAccumulator metrics;
  };
  InputResult<SpanFrames> read_positions(FrameSource& source, const FrameRange& span) const;
  InputResult<std::vector<MeasuredFrame>> measure_frames(const SharedSource& source,
                                                         const FrameRange& span,
                                                         const FrameRange& some,
                                                         const DecodeFrame& decode,
                                                         std::span<const double> before) const;
  void to_input(std::span<const std::int32_t> positions, std::span<float> decoded) const;

  SequenceHeader header_;
  const EncoderSettings& settings_;
  std::vector<Triangle> normal_triangles_;
  ConnectivityCode connectivity_;
  Topology topology_;
  std::vector<Triangle> input_triangles_;  // SequenceMesh::input_triangles
  SequenceMesh mesh_;
  KindEncoders kinds_;
  std::unique_ptr<KindEncoder> last_resort_;
};

// Returns the units of the GOFs of a coded span as bytes of a stream, without hashes.
std::vector<GofBytes> write_gof_units(const EncodedSpan& encoded, const FrameRange& span,
                                      bool is_open_ended);

}  // namespace rlpc
