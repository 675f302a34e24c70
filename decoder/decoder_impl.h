// Decoder::Impl (decoder/rlpc_decoder.h): iterates over access units and their frames.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/memory/owned.h"
#include "common/parallel/for_each.h"
#include "decoder/codec/gofs/gof_source.h"
#include "decoder/codec/gofs/output_order.h"
#include "decoder/codec/units/stream_reader.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {

class Decoder::Impl : public Owned {
 public:
  Impl(std::unique_ptr<ByteSource> source, const DecoderOptions& options);

  // coarse_layers: as in DecoderOptions.
  Result<bool> open(std::uint32_t coarse_layers);
  Result<bool> next_frame(std::span<std::int32_t> positions);
  Result<bool> seek(std::uint32_t frame);
  Result<bool> frame(std::uint32_t frame, std::span<std::int32_t> positions);
  Result<bool> prefetch(std::uint32_t frame);
  Result<GofRange> gof_of(std::uint32_t frame);
  Result<Vector<GofRange>> gofs();
  Result<std::optional<std::uint32_t>> skip_damage();
  Result<std::uint32_t> parse_rest();
  Result<String> asset();
  Result<Vector<AttributeSet>> attributes();
  std::optional<SkeletonPose> pose();

  const StreamReader& stream() const { return stream_; }
  const OutputOrder& output() const { return output_; }
  std::uint32_t num_layers() const;
  std::optional<std::uint32_t> num_frames();
  DecoderMemory memory() const {
    return {stream_.bytes_in_use(), gofs_.gof_bytes(), gofs_.cached_bytes()};
  }
  std::uint32_t position() const { return position_; }
  bool was_cut() const { return was_cut_ || gofs_.was_cut(); }
  std::uint32_t compared_frames() const { return compared_frames_; }

 private:
  // The skeleton returned last, and the first frame of its GOF.
  struct LastSkeleton {
    std::shared_ptr<const Skeleton> skeleton;
    std::optional<std::uint32_t> first_frame;
  };

  // Returns the direction of a frame from the last one decoded.
  Direction direction_of(std::uint32_t frame) const;
  // Decodes the first frame of the whole mesh, uncut, in decoded order; then restores the
  // state.
  Result<Vector<std::int32_t>> first_frame();
  Result<Vector<std::int32_t>> decode_first_frame();
  // Returns false after the last frame of the GOF.
  Result<bool> decode_live_frame(std::span<std::int32_t> positions);
  Result<bool> decode_frame(std::span<std::int32_t> positions);
  // Sets the sticky error. Drops the loaded GOF, which may no longer match the position.
  void fail(const Error& error);

  StreamReader stream_;
  ThreadPool threads_;
  GofSource gofs_;
  OutputOrder output_;
  std::optional<Error> failure_;  // sticky until a successful seek
  std::uint32_t position_ = 0;
  std::optional<std::uint32_t> last_frame_;  // last frame decoded
  std::uint32_t compared_frames_ = 0;
  bool was_cut_ = false;  // apart from GOFs of gofs_
  LastSkeleton last_skeleton_;
};

}  // namespace rlpc
