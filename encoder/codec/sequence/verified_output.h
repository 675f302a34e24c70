// Passes on the bytes of a stream as soon as a decoder has verified them, for frames that
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

// Releases bytes that the decoder no longer needs, unless the settings ask for a check of the
// whole stream at its end.
class VerifiedOutput {
 public:
  // Keeps a reference to the settings.
  VerifiedOutput(const EncoderSettings& settings, bool is_open_ended);
  VerifiedOutput(const VerifiedOutput&) = delete;
  VerifiedOutput& operator=(const VerifiedOutput&) = delete;

  // Returns a sink that holds bytes back until pass_on(). It refers to this output.
  ByteSink collector();
  // Checks the contents from the input; call it when the first GOF, or the part that its first
  // frame needs, is complete and before any frame is verified. has_attributes: the stream has
  // attributes. Error: the contents break a rule.
  std::optional<InputError> check_contents(bool has_attributes);
  // Returns the verifier; the first call, once the header is known, makes it. threads: threads
  // of the decoder of an open-ended stream; other streams are decoded by one thread, without
  // lookahead.
  StreamVerifier& verifier(const SequenceHeader& header, const ConnectivityCode& connectivity,
                           std::uint32_t threads);
  // Returns StreamVerifier::largest_rounding().
  double largest_rounding() const { return verifier_ ? verifier_->largest_rounding() : 0.0; }
  // Passes on the collected bytes, which the caller has verified. Error: the sink failed.
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
