// RLPC encoder for frames that arrive one by one: the public interface for sources that cannot
// be read repeatedly. rlpc_encoder.h has the interface for all others.
//
//   auto encoder = rlpc::FrameEncoder::create(format, settings, sink);
//   if (!encoder) return complain(encoder.error().message);
//   for (const auto& xyz : frames) {
//     if (const auto error = encoder->add_frame(xyz)) return complain(error->message);
//   }
//   const auto report = encoder->finish();
//   if (!report) return complain(report.error().message);
//
// Without a number of frames (FrameFormat::num_frames), the stream is open-ended: frames are
// added until finish(). With settings.low_delay, each frame is coded and passed to the sink at
// once, in inter GOFs; a frame that is refused is left out, and encoding can go on. Both
// need the High profile. The next two paragraphs are about encoding without low_delay.
//
// GOFs have equal length, at most settings.gof_frames (by default 128, or 256 in the High
// profile). Each is encoded when its last frame has been added, and its bytes are passed to the
// sink at once. In the High profile, several GOFs are held and encoded together as a *span*, up
// to FrameFormat::max_held_frames, so that they can use one shared rig. Later spans use that
// rig too if a new one costs more. Memory is needed for the mesh, one span and its analysis, a
// shared rig, and 32 bytes per GOF for the index; otherwise it does not grow with the sequence.
//
// encode() meets the target over the whole sequence; here each span (outside the High profile:
// each GOF) meets it separately, with the same tolerance: a KG error relative to the spread of
// its own frames, a maximum error, or a rate that includes a share, by its number of frames, of
// all bits outside GOFs. Thus the whole stream meets the target too. If the motion varies
// between spans, this costs more than encode().
//
// A decoder verifies frames as soon as they can be decoded. Spans, and frames of an open-ended
// stream with low delay, are verified before their bytes are passed on; frames of other streams
// with low delay, when their GOF is complete. The end of the stream is passed on once all
// frames have been verified.
//
// The level is written before the first GOF and cannot change. It is the lowest that allows the
// mesh, the length of the GOFs, and twice the factors, clusters, components and unit size of
// the first span. A later one that needs more is an error; FrameFormat::least_level avoids it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "encoder/codec/frame_format.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

class FrameBackend;

class FrameEncoder {
 public:
  // Creates an encoder. Errors: an invalid format; settings that encode() would refuse; a mesh
  // or length that no level allows; too much memory. Nothing is passed to the sink before the
  // first span is encoded.
  static InputResult<FrameEncoder> create(FrameFormat format, EncoderSettings settings,
                                          ByteSink sink);
  FrameEncoder(FrameEncoder&&) noexcept;
  FrameEncoder& operator=(FrameEncoder&&) noexcept;
  ~FrameEncoder();

  // Adds the next frame, [num_vertices][3], in units. exact: the numbers that xyz was rounded
  // from, of the same shape, against which errors are measured; empty: the floats themselves.
  // Errors: a wrong number of values; a NaN, or a coordinate outside the box; more than
  // num_frames frames; a span that needs a higher level; frames that fail verification; a sink
  // that fails. Errors are sticky, except a frame that is refused with low delay.
  std::optional<InputError> add_frame(std::span<const float> xyz,
                                      std::span<const double> exact = {});
  // Ends the stream, after the last frame. Errors: fewer than num_frames frames, or none; a
  // sink that fails. In the report, metrics covers the whole sequence but lists no single
  // frames, step is the last span's, and target_met is true if every span met the target.
  InputResult<EncodeReport> finish();

  // Returns the number of frames added so far.
  std::uint32_t num_added() const;

 private:
  explicit FrameEncoder(std::unique_ptr<FrameBackend> coder);
  std::unique_ptr<FrameBackend> coder_;
};

}  // namespace rlpc
