// Verifies a stream by decoding it, while it is written or before it leaves the encoder.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/verify/frame_reader.h"
#include "common/verify/stream_buffer.h"
#include "encoder/codec/report.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// The encoder's reports about frames come from its own reconstruction. The verifier lets a
// decoder decode the bytes, and compares the result with the input, or with the positions that
// the encoder has compared with the input: an encoding that breaks its promise is an error, and
// never becomes a stream.
class StreamVerifier {
 public:
  // Keeps a reference to the settings. input_vertex: [decoded vertex], index in the input; a
  // copy is kept. buffer: receives the bytes of the stream, from the first on, in the order in
  // which frames are verified. threads: threads of the decoder.
  StreamVerifier(const EncoderSettings& settings, const SequenceHeader& header,
                 std::span<const std::uint32_t> input_vertex,
                 std::shared_ptr<StreamBuffer> buffer, std::uint32_t threads);
  // Measures vertex normals as well. triangles: of the input; must stay.
  void measure_normals(std::span<const Triangle> triangles) { normal_triangles_ = triangles; }

  // Decodes the next frame of the stream and compares it with its original, the numbers of the
  // input [num_vertices][3] in input order. Errors: the stream cannot be decoded; with a
  // lossless target, a coordinate differs.
  std::optional<InputError> check_frame(std::span<const double> exact);
  // Does the same for the next `count` frames, which are those of the source from `first` on.
  // Errors: also errors of the source.
  std::optional<InputError> check_frames(FrameSource& source, std::uint32_t first,
                                         std::uint32_t count);

  // Replaces check_frame() where originals do not stay until their frame can be decoded:
  // compares the positions, in decoded order, that the encoder expects of a frame with the
  // original, and notes them; check_expected() then decodes all frames noted so far and
  // compares them with these.
  std::optional<InputError> expect(std::span<const std::int32_t> positions,
                                   std::span<const double> exact);
  std::optional<InputError> check_expected();

  // Checks the end of the complete stream, after the last frame, and that `reported` is what
  // check_frame() has measured, if it was called.
  std::optional<InputError> finish(const Metrics& reported);

  // Returns the RMS deviation of vertex normals that check_frame() has measured, in degrees;
  // none if it was not asked to, or no triangle has an area.
  std::optional<double> vertex_normals() const { return metrics_.result().vertex_normals; }
  // Returns the largest distance of an input vertex from the floats that were coded, in units.
  double largest_rounding() const { return largest_rounding_; }

 private:
  InputError fault(const std::string& what) const;
  std::optional<InputError> decode();
  void note_rounding(std::span<const double> exact);
  std::optional<InputError> compare_without_loss(std::uint32_t frame,
                                                 std::span<const double> exact,
                                                 std::span<const float> decoded) const;

  const EncoderSettings& settings_;
  SequenceHeader header_;
  std::vector<std::uint32_t> input_vertex_;   // [decoded vertex]; empty: input order
  std::vector<std::uint32_t> output_vertex_;  // [decoded vertex], in the order of decoders
  std::unique_ptr<FrameReader> reader_;
  std::uint32_t num_checked_ = 0;
  std::vector<std::int32_t> positions_;  // the last frame, as decoders output it
  std::deque<std::uint64_t> expected_;   // hashes of frames that are to be decoded
  std::span<const Triangle> normal_triangles_;
  MetricsAccumulator metrics_;
  bool has_metrics_ = false;
  double largest_rounding_ = 0.0;
};

// Returns the largest distance of a vertex of a source from the floats nearest to its numbers,
// in units. Error: it exceeds `max`, so that no decoded positions, which are floats, can be as
// near. Reads all frames, unless they are floats.
InputResult<double> check_rounding(FrameSource& source, double max);

// Checks a stream against the rules of the specification: all of it if the settings say so,
// otherwise the contents from the input, up to the end of the first GOF. An error names the
// rule.
std::optional<InputError> check_rules(const EncoderSettings& settings, bool has_attributes,
                                      const std::shared_ptr<StreamBuffer>& stream,
                                      std::uint64_t end_of_first_gof);

// Whether a stream has at most the bits of the target, if that is a rate.
inline bool meets_rate(const Target& target, const EncodeReport& report) {
  return target.kind != Target::kBpvf || report.bpvf <= target.value;
}

}  // namespace rlpc
