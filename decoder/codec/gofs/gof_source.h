// The GOFs that a decoder takes frames from: the current one, those that are cached, and those
// that other threads prepare ahead.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/memory/owned.h"
#include "common/parallel/for_each.h"
#include "decoder/codec/gofs/frame_band.h"
#include "decoder/codec/gofs/gof_cache.h"
#include "decoder/codec/gofs/live_gof.h"
#include "decoder/codec/gofs/prefetch.h"
#include "decoder/codec/options.h"
#include "decoder/codec/recon/rig_recons.h"
#include "decoder/codec/units/stream_reader.h"

namespace rlpc {

class GofSource {
 public:
  // The stream, which need not be open, and the threads must outlive it. Uses limits,
  // verify_hashes, trace, max_cached_bytes and forward_only of the options.
  GofSource(StreamReader& stream, ThreadPool& threads, std::uint32_t num_threads,
            const DecoderOptions& options);
  GofSource(const GofSource&) = delete;
  GofSource& operator=(const GofSource&) = delete;

  // Starts, once the stream is open.
  void open();

  // The current GOF, or one whose frames are decoded as they arrive; at most one is not null.
  LoadedGof* gof() { return gof_.get(); }
  LiveGof* live() { return live_.get(); }
  bool has_frame(std::uint32_t frame) const {
    if (live_) return live_->may_have(frame);
    return gof_ && gof_->has_frame(frame);
  }
  // Returns whether a GOF is decoded frame by frame.
  Result<bool> is_live(const UnitHeader& unit);
  // Returns frame f of the current GOF in decoded order; valid until the next call.
  std::span<const std::int32_t> frame(std::uint32_t f);

  // Sets the direction of the frames that are needed next.
  void turn(Direction direction) { direction_ = direction; }
  // Frames are needed out of order: a GOF whose frames arrive one by one is read whole.
  void expect_any_order() { in_any_order_ = true; }
  // Loads the next GOF of the stream. Returns false at the end of the sequence.
  Result<bool> load_next();
  // Loads the GOF that has the frame.
  Result<bool> go_to(std::uint32_t frame);
  // Leaves a live GOF after its last frame.
  void leave_live() { live_.reset(); }
  // Drops the current GOF without caching it.
  void drop_current();
  // Drops also the GOFs prepared ahead: the stream goes on elsewhere.
  void drop();

  // Starts preparing the next GOFs in the direction of playback.
  void look_ahead();
  // Prepares the GOF that has the frame, so that taking the frame takes little time.
  Result<bool> prefetch(std::uint32_t frame);

  RigRecons& rigs() { return rigs_; }
  bool verifies_hashes() const { return options_.verify_hashes; }
  // Returns whether any current GOF so far had lost slices.
  bool was_cut() const { return was_cut_; }
  std::uint64_t gof_bytes() const { return gof_ ? gof_->gof.memory_bytes : 0; }
  std::uint64_t cached_bytes() const { return cache_.bytes(); }

 private:
  struct Options {
    std::uint32_t threads;
    bool verify_hashes;
    bool forward_only;
    bool prefetches;
    std::uint64_t prefetch_bytes;  // of a GOF
    std::uint64_t max_cached_bytes;
  };

  // Makes a GOF the current one.
  void enter(std::unique_ptr<LoadedGof> gof);
  // Caches the current GOF.
  void leave();
  void count_cached_bytes();
  Result<std::unique_ptr<LoadedGof>> find(const UnitHeader& unit);
  Result<std::unique_ptr<LoadedGof>> read(const UnitHeader& unit);
  std::unique_ptr<LoadedGof> loaded(std::uint64_t offset, std::uint64_t end,
                                    PreparedGof gof) const;

  StreamReader& stream_;
  ThreadPool& threads_;
  const Options options_;
  RigRecons rigs_;
  GofCache cache_;
  FrameBand band_;
  std::unique_ptr<LoadedGof> gof_;
  std::unique_ptr<LiveGof> live_;
  Direction direction_ = Direction::kForward;
  std::optional<Direction> looked_ahead_;  // direction of look_ahead() in the current GOF
  bool in_any_order_ = false;
  bool was_cut_ = false;
  std::optional<Prefetch> prefetch_;  // last: its threads use the others
};

}  // namespace rlpc
