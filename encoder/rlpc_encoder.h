// RLPC encoder: the public interface.
//
//   rlpc::EncoderSettings settings;
//   settings.target = {rlpc::Target::kKg, 0.1};
//   const auto sink = [&](auto bytes) { return write(bytes); };
//   const auto report = rlpc::encode(source, settings, sink);
//   if (!report) return complain(report.error().message);
//
// Errors name settings in quotes, as members are called: 'gof_frames'.
//
// encode() decodes the finished stream with the decoder of this project before it passes on any
// byte. If the stream cannot be decoded, its error is not the one reported, or it is not
// lossless though it should be, encode() fails and the sink receives nothing.
//
// The same input and settings give the same bytes with every compiler and on every machine. The
// encoder holds the frames of one GOF at a time, and the analyses of all GOFs if they are small
// enough; it reads frames from the source repeatedly. Use FrameEncoder (frame_encoder.h) for
// frames that can be read only once.
#pragma once

#include "encoder/codec/report.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/open/open_source.h"

namespace rlpc {

// Encodes a whole sequence and passes the stream to `sink`. Any thread may read from the
// source, one at a time. Errors: errors of the source; an animation that no level allows;
// contradictory settings, or settings of another profile; too much memory; input numbers that
// floats cannot represent within the maximum error of the target; a stream that fails
// verification; a sink that fails.
InputResult<EncodeReport> encode(FrameSource& source, const EncoderSettings& settings,
                                 const ByteSink& sink, const Progress& progress = {});

}  // namespace rlpc
