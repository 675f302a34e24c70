#include "encoder/frame_encoder.h"

#include <memory>
#include <utility>

#include "encoder/codec/sequence/check_frames.h"
#include "encoder/codec/sequence/check_settings.h"
#include "encoder/codec/sequence/low_delay_encoder.h"
#include "encoder/codec/sequence/span_encoder.h"
#include "encoder/complete_settings.h"

namespace rlpc {
namespace {

std::optional<InputError> check(const FrameFormat& format, const EncoderSettings& settings) {
  if (auto error = check_format(format)) return error;
  if (auto error = check_settings(settings)) return error;
  if (auto error = check_attributes(settings.attributes, format.attributes)) return error;
  if (format.num_frames > 0) {
    if (auto error = check_clips(settings.clips, format.num_frames)) return error;
  }
  if (format.num_frames == 0 && settings.profile != Profile::kHigh) {
    return InputError{
        "a stream needs a number of frames; only the High profile has streams without"};
  }
  if (settings.target.kind == Target::kLossless && settings.target.value == 0.0) {
    return InputError{
        "the grid of frames that are yet to come is not known: lossless coding needs a number "
        "of bits ('target = lossless, target_value = BITS')"};
  }
  return std::nullopt;
}

}  // namespace

InputResult<FrameEncoder> FrameEncoder::create(FrameFormat format, EncoderSettings settings,
                                               ByteSink sink) {
  settings = complete_settings(std::move(settings), format.clips, format.asset);
  if (auto error = check(format, settings)) return *error;
  std::unique_ptr<FrameBackend> coder;
  if (settings.low_delay) {
    coder = std::make_unique<LowDelayEncoder>(std::move(format), std::move(settings),
                                              std::move(sink));
  } else {
    coder =
        std::make_unique<SpanEncoder>(std::move(format), std::move(settings), std::move(sink));
  }
  if (auto error = coder->prepare()) return *error;
  return FrameEncoder(std::move(coder));
}

FrameEncoder::FrameEncoder(std::unique_ptr<FrameBackend> coder) : coder_(std::move(coder)) {}
FrameEncoder::FrameEncoder(FrameEncoder&&) noexcept = default;
FrameEncoder& FrameEncoder::operator=(FrameEncoder&&) noexcept = default;
FrameEncoder::~FrameEncoder() = default;

std::optional<InputError> FrameEncoder::add_frame(std::span<const float> xyz,
                                                  std::span<const double> exact) {
  return coder_->add_frame(xyz, exact);
}
InputResult<EncodeReport> FrameEncoder::finish() { return coder_->finish(); }
std::uint32_t FrameEncoder::num_added() const { return coder_->num_added(); }

}  // namespace rlpc
