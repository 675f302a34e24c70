// Decoder::Impl (decoder/rlpc_decoder.h): iterates over access units and their frames.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "common/memory/owned.h"
#include "common/parallel/for_each.h"
#include "decoder/codec/gofs/coarse_output.h"
#include "decoder/codec/gofs/frame_band.h"
#include "decoder/codec/gofs/gof_cache.h"
#include "decoder/codec/gofs/live_gof.h"
#include "decoder/codec/gofs/prefetch.h"
#include "decoder/codec/units/stream_reader.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {

class Decoder::Impl : public Owned {
 public:
  Impl(std::unique_ptr<ByteSource> source, const DecoderOptions& options);

  Result<bool> open();
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
  const std::optional<CoarseOutput>& coarse() const { return coarse_; }
  std::uint32_t num_vertices() const {
    return coarse_ ? static_cast<std::uint32_t>(coarse_->vertices().size())
                   : stream_.header().num_vertices;
  }
  std::uint32_t num_layers() const;
  std::optional<std::uint32_t> num_frames();
  DecoderMemory memory() const {
    return {stream_.bytes_in_use(), gof_ ? gof_->gof.memory_bytes : 0, cache_.bytes()};
  }
  std::uint32_t position() const { return position_; }
  bool was_cut() const { return was_cut_; }
  std::uint32_t compared_frames() const { return compared_frames_; }

 private:
  bool has_frame(std::uint32_t frame) const {
    if (live_) return live_->may_have(frame);
    return gof_ && gof_->has_frame(frame);
  }
  // Returns the direction of a frame from the last one decoded.
  Direction direction_of(std::uint32_t frame) const;
  // Loads the next GOF of the stream. Returns false at the end of the sequence.
  Result<bool> load_gof();
  Result<bool> go_to_gof_of(std::uint32_t frame);
  // Makes a GOF the current one.
  void enter(std::unique_ptr<LoadedGof> gof);
  // Caches the current GOF.
  void leave_gof();
  void count_cached_bytes();
  Result<std::unique_ptr<LoadedGof>> find_gof(const UnitHeader& unit);
  Result<std::unique_ptr<LoadedGof>> read_gof(const UnitHeader& unit);
  std::unique_ptr<LoadedGof> loaded(std::uint64_t offset, std::uint64_t end, PreparedGof gof);
  Result<bool> is_live(const UnitHeader& unit);
  // Starts preparing the next GOFs in the direction of playback.
  void look_ahead();
  // Decodes the first frame of the whole mesh, uncut, in decoded order; then restores the
  // state.
  Result<Vector<std::int32_t>> first_frame();
  Result<Vector<std::int32_t>> decode_first_frame();
  // Returns false after the last frame of the GOF.
  Result<bool> decode_live_frame(std::span<std::int32_t> positions);
  Result<bool> decode_frame(std::span<std::int32_t> positions);
  // Sets the sticky error. Drops the loaded GOF, which may no longer match the position.
  void fail(const Error& error);
  void to_output_order(std::span<const std::int32_t> decoded,
                       std::span<std::int32_t> positions) const;

  StreamReader stream_;
  RigRecons rigs_;
  bool verify_hashes_;
  std::uint32_t coarse_layers_;
  std::optional<CoarseOutput> coarse_;
  std::uint32_t num_threads_;
  ThreadPool threads_;
  std::unique_ptr<LoadedGof> gof_;
  std::unique_ptr<LiveGof> live_;  // instead of gof_
  std::uint64_t max_cached_bytes_;
  GofCache cache_;
  FrameBand band_;
  bool wants_prefetch_ = false;
  std::uint64_t prefetch_bytes_ = 0;
  bool forward_only_ = false;
  std::optional<Prefetch> prefetch_;
  std::optional<Error> failure_;  // sticky until a successful seek
  std::uint32_t position_ = 0;
  std::optional<std::uint32_t> last_frame_;  // last frame decoded
  Direction direction_ = Direction::kForward;
  std::optional<Direction> looked_ahead_;  // direction of look_ahead() in the current GOF
  bool is_random_ = false;                 // frames have been decoded out of order
  bool was_cut_ = false;
  std::uint32_t compared_frames_ = 0;
  std::shared_ptr<const Skeleton> skeleton_;        // last skeleton returned
  std::optional<std::uint32_t> gof_with_skeleton_;  // first frame of its GOF
};

}  // namespace rlpc
