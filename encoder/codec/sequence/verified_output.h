// Passes the bytes of a stream on as soon as a decoder has verified them, for frames that
// arrive one by one.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/verify/stream_buffer.h"
#include "encoder/codec/report.h"
#include "encoder/codec/sequence/stream_verifier.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/write/write_connectivity.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Bytes that the decoder no longer needs are released, unless the settings have the whole
// stream checked at its end.
class VerifiedOutput {
 public:
  // Keeps a reference to the settings.
  VerifiedOutput(const EncoderSettings& settings, bool is_open_ended);
  VerifiedOutput(const VerifiedOutput&) = delete;
  VerifiedOutput& operator=(const VerifiedOutput&) = delete;

  // A sink that holds bytes back until pass_on(). It refers to this output.
  ByteSink collector();
  // To be called when the first GOF is complete, or as much of it as its first frame needs, and
  // before any frame is verified. has_attributes: the stream has attributes. Error: what the
  // input brings breaks a rule.
  std::optional<InputError> check_contents(bool has_attributes);
  // Made by the first call, once the header is known. threads: of the decoder of an open-ended
  // stream; others are decoded by one, which does not look ahead.
  StreamVerifier& verifier(const SequenceHeader& header, const ConnectivityCode& connectivity,
                           std::uint32_t threads);
  // As of StreamVerifier.
  double largest_rounding() const { return verifier_ ? verifier_->largest_rounding() : 0.0; }
  // Passes on what has been collected, and verified by the caller. Error: the sink failed.
  std::optional<InputError> pass_on(const ByteSink& sink);
  // Verifies the end of the stream, and passes it on.
  std::optional<InputError> finish(const Metrics& reported, const ByteSink& sink);

 private:
  const EncoderSettings& settings_;
  bool is_open_ended_;
  std::shared_ptr<StreamBuffer> stream_;  // for the decoder
  StreamBuffer held_{StreamBuffer::Keep::kAll};
  std::optional<StreamVerifier> verifier_;
};

}  // namespace rlpc
