#include "common/verify/frame_reader.h"

#include <limits>
#include <utility>

#include "decoder/describe_error.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/verify/buffer_source.h"

namespace rlpc {
namespace {

// Returns limits without a maximum: the encoder may read whatever it was allowed to write.
DecodeLimits no_limits() {
  constexpr auto kAny = std::numeric_limits<std::uint32_t>::max();
  return {kAny, kAny, kMaxFrames, std::numeric_limits<std::uint64_t>::max()};
}

class DecodedFrames final : public FrameReader {
 public:
  DecodedFrames(std::shared_ptr<StreamBuffer> stream, std::uint32_t threads)
      : stream_(std::move(stream)) {
    options_.limits = no_limits();
    options_.threads = threads;
    options_.forward_only = true;
  }

  std::optional<std::string> next_frame(std::span<std::int32_t> positions) override {
    if (auto wrong = open()) return wrong;
    if (positions.size() != 3 * std::size_t{decoder_->num_vertices()}) {
      return "the stream has " + std::to_string(decoder_->num_vertices()) + " vertices";
    }
    const auto more = decoder_->next_frame(positions);
    if (!more) return describe_error(more.error());
    if (!*more) return "the stream ends before the frame";
    return std::nullopt;
  }

  std::optional<std::string> finish() override {
    if (auto wrong = open()) return wrong;
    std::vector<std::int32_t> positions(3 * std::size_t{decoder_->num_vertices()});
    const auto more = decoder_->next_frame(positions);
    if (!more) return describe_error(more.error());
    if (*more) return "the stream has more frames than were encoded";
    return std::nullopt;
  }

 private:
  // Opens the stream if it is not open, and decodes everything before the frames.
  std::optional<std::string> open() {
    if (decoder_) return std::nullopt;
    auto source = std::make_unique<BufferSource>(stream_);
    BufferSource& bytes = *source;
    auto decoder = Decoder::open(std::move(source), options_);
    if (!decoder) return describe_error(decoder.error());
    decoder_.emplace(std::move(*decoder));
    if (decoder_->has_attributes()) {
      if (const auto sets = decoder_->attributes(); !sets) return describe_error(sets.error());
    }
    if (const auto asset = decoder_->asset(); !asset) return describe_error(asset.error());
    // Attributes may have needed the first frame, which is decoded again.
    bytes.release_forgotten();
    return std::nullopt;
  }

  std::shared_ptr<StreamBuffer> stream_;
  DecoderOptions options_;
  std::optional<Decoder> decoder_;
};

}  // namespace

std::unique_ptr<FrameReader> read_frames(std::shared_ptr<StreamBuffer> stream,
                                         std::uint32_t threads) {
  return std::make_unique<DecodedFrames>(std::move(stream), threads);
}

}  // namespace rlpc
