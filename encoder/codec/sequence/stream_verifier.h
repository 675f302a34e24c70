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

// What the encoder says of frames comes from its own reconstruction. The verifier has a decoder
// decode the bytes, and compares the result with the input, or with what the encoder has
// compared with the input: an encoding that does not keep its promise is an error, never a
// stream that claims to.
class StreamVerifier {
 public:
  // Keeps a reference to the settings. input_vertex: [decoded vertex], index in the input; a
  // copy is kept. buffer: gets the bytes of the stream, from the first on, in the order in
  // which frames are verified. threads: of the decoder.
  StreamVerifier(const EncoderSettings& settings, const SequenceHeader& header,
                 std::span<const std::uint32_t> input_vertex,
                 std::shared_ptr<StreamBuffer> buffer, std::uint32_t threads);

  // Decodes the next frame of the stream and compares it with its original, the numbers of the
  // input [num_vertices][3] in input order. Errors: the stream cannot be decoded; with a
  // lossless target, a coordinate differs.
  std::optional<InputError> check_frame(std::span<const double> exact);
  // The same for the next `count` frames, which are those of the source from `first` on.
  // Errors: those of the source as well.
  std::optional<InputError> check_frames(FrameSource& source, std::uint32_t first,
                                         std::uint32_t count);

  // Where originals do not stay until their frame can be decoded: compares the positions, in
  // decoded order, that the encoder expects of a frame with the original, as check_frame() does
  // with decoded ones, and notes them; check_expected() then decodes all frames noted so far,
  // and compares them with these.
  std::optional<InputError> expect(std::span<const std::int32_t> positions,
                                   std::span<const double> exact);
  std::optional<InputError> check_expected();

  // After the last frame, once the stream is complete: checks its end, and that `reported` is
  // what check_frame() has measured, if that was called.
  std::optional<InputError> finish(const Metrics& reported);

  // The largest distance of a vertex of the input from the floats that were coded, in units.
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
  std::vector<std::uint32_t> input_vertex_;   // of decoded positions; empty: in input order
  std::vector<std::uint32_t> output_vertex_;  // [decoded vertex], in the order of decoders
  std::unique_ptr<FrameReader> reader_;
  std::uint32_t num_checked_ = 0;
  std::vector<std::int32_t> positions_;  // of the last frame, as decoders output it
  std::deque<std::uint64_t> expected_;   // hashes of frames that are to be decoded
  MetricsAccumulator metrics_;
  bool has_metrics_ = false;
  double largest_rounding_ = 0.0;
};

// The largest distance of a vertex of a source from the floats nearest to its numbers, in
// units. Error: it exceeds `most`, so that no decoded positions, which are floats, are as near.
// Reads all frames, unless they are floats.
InputResult<double> check_rounding(FrameSource& source, double most);

// Holds a stream against the rules of the specification: all of it if the settings say so,
// otherwise what the input brings, up to the end of the first GOF. An error names the rule.
std::optional<InputError> check_rules(const EncoderSettings& settings, bool has_attributes,
                                      const std::shared_ptr<StreamBuffer>& stream,
                                      std::uint64_t end_of_first_gof);

// Whether a stream has no more than the bits of the target, if that is a rate.
inline bool meets_rate(const Target& target, const EncodeReport& report) {
  return target.kind != Target::kBpvf || report.bpvf <= target.value;
}

}  // namespace rlpc
