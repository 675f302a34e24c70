#include "encoder/codec/sequence/verified_output.h"

#include <utility>

namespace rlpc {

VerifiedOutput::VerifiedOutput(const EncoderSettings& settings, bool is_open_ended)
    : settings_(settings),
      is_open_ended_(is_open_ended),
      stream_(std::make_shared<StreamBuffer>(
          settings.check_rules ? StreamBuffer::Keep::kAll : StreamBuffer::Keep::kNeeded)) {}

ByteSink VerifiedOutput::collector() {
  return [this](std::span<const std::uint8_t> bytes) {
    stream_->add(bytes);
    held_.add(bytes);
    return true;
  };
}

// With check_rules, the whole stream is checked at the end.
std::optional<InputError> VerifiedOutput::check_contents(bool has_attributes) {
  if (settings_.check_rules) return std::nullopt;
  return check_rules(settings_, has_attributes, stream_, stream_->size());
}

StreamVerifier& VerifiedOutput::verifier(const SequenceHeader& header,
                                         const ConnectivityCode& connectivity,
                                         std::uint32_t threads) {
  if (!verifier_) {
    verifier_.emplace(settings_, header, connectivity.input_vertex, stream_,
                      is_open_ended_ ? threads : 1);
  }
  return *verifier_;
}

std::optional<InputError> VerifiedOutput::pass_on(const ByteSink& sink) {
  const StreamBuffer verified = std::exchange(held_, StreamBuffer(StreamBuffer::Keep::kAll));
  if (verified.for_each_piece(sink)) return std::nullopt;
  return InputError{"the stream could not be written"};
}

std::optional<InputError> VerifiedOutput::finish(const Metrics& reported,
                                                 const ByteSink& sink) {
  if (auto error = verifier_->finish(reported)) return error;
  if (settings_.check_rules) {
    if (auto error = check_rules(settings_, true, stream_, stream_->size())) return error;
  }
  return pass_on(sink);
}

}  // namespace rlpc
