#include "decoder/codec/gofs/gof_source.h"

#include <algorithm>
#include <utility>

#include "common/codec/syntax/gof_header.h"
#include "decoder/codec/gofs/prepared_gof.h"

namespace rlpc {

static_assert(kBandFrames == kFramesHeld);

GofSource::GofSource(StreamReader& stream, ThreadPool& threads, std::uint32_t num_threads,
                     const DecoderOptions& options)
    : stream_(stream),
      threads_(threads),
      // A trace follows the order of the stream.
      options_{
          num_threads,
          options.verify_hashes,
          options.forward_only,
          num_threads > 1 && options.trace == nullptr,
          options.limits.max_memory_bytes / (std::uint64_t{2} * std::max(1U, num_threads - 1)),
          options.max_cached_bytes},
      rigs_(stream.context()),
      cache_(options.max_cached_bytes),
      band_(num_threads) {
  stream_.rigs().when_dropped([this] { rigs_.erase_unused(); });
}

void GofSource::open() {
  // Prefetching would wait for GOFs that are yet to come.
  if (!options_.prefetches || stream_.header().open_end_flag) return;
  prefetch_.emplace(stream_, rigs_, threads_, options_.prefetch_bytes,
                    options_.max_cached_bytes / 2, options_.threads - 1);
}

std::span<const std::int32_t> GofSource::frame(std::uint32_t f) {
  band_.turn(direction_);
  return band_.frame(*gof_->gof.recon, f, 3 * std::size_t{stream_.header().num_vertices});
}

void GofSource::drop_current() {
  gof_.reset();
  live_.reset();
}

void GofSource::drop() {
  drop_current();
  if (prefetch_) prefetch_->clear();
}

// Returns whether the GOF is decoded frame by frame.
Result<bool> GofSource::is_live(const UnitHeader& unit) {
  if (!stream_.header().open_end_flag) return false;
  const auto header = stream_.gof_header(unit);
  if (!header) return false;  // reading the GOF reports this error or an earlier one
  return rlpc::is_live(stream_.header(), header->kind);
}

void GofSource::leave() {
  cache_.put(std::move(gof_));
  gof_.reset();
  live_.reset();
  band_.clear();
  count_cached_bytes();
}

void GofSource::count_cached_bytes() {
  const std::uint64_t frame_bytes = gof_ ? gof_->gof.frame_bytes : 0;
  cache_.set_max_bytes(options_.max_cached_bytes -
                       std::min(options_.max_cached_bytes, frame_bytes));
  stream_.set_cached_bytes(cache_.bytes() + frame_bytes);
}

void GofSource::enter(std::unique_ptr<LoadedGof> gof) {
  gof_ = std::move(gof);
  was_cut_ = was_cut_ || gof_->gof.is_cut;
  looked_ahead_.reset();
  count_cached_bytes();
}

std::unique_ptr<LoadedGof> GofSource::loaded(std::uint64_t offset, std::uint64_t end,
                                             PreparedGof gof) const {
  HashCheck check;
  if (!gof.is_cut) {
    if (!options_.verify_hashes) gof.frame_crcs.clear();
    check = {std::move(gof.hash), std::move(gof.frame_crcs), gof.header.num_frames};
  }
  return std::make_unique<LoadedGof>(
      LoadedGof{{}, offset, end, std::move(gof), std::move(check)});
}

Result<bool> GofSource::load_next() {
  leave();
  if (prefetch_) prefetch_->hand_over_rigs();
  const auto unit = stream_.find_gof();
  if (!unit) return unit.error();
  if (!*unit) return false;
  if (options_.forward_only) stream_.units().forget((*unit)->offset);
  const auto live = is_live(**unit);
  if (!live) return live;
  // Frames out of order need the whole GOF, unless an error follows them.
  if (!*live || in_any_order_) {
    auto gof = find(**unit);
    if (gof) enter(std::move(*gof));
    if (gof || !*live) return gof ? Result<bool>(true) : Result<bool>(gof.error());
  }
  live_ = std::make_unique<LiveGof>(stream_, stream_.access_units().cut());
  return live_->begin(**unit);
}

// Returns the GOF that begins with a unit: cached, prefetched, or parsed now.
Result<std::unique_ptr<LoadedGof>> GofSource::find(const UnitHeader& unit) {
  const std::uint32_t first_frame = stream_.next_first_frame();
  if (auto kept = cache_.take_at(unit.offset)) {
    stream_.go_past(unit, kept->header().num_frames, kept->end);
    return kept;
  }
  if (prefetch_) {
    if (direction_ == Direction::kForward) {
      prefetch_->fill(unit.offset, first_frame, options_.threads);
    }
    if (auto found = prefetch_->take(unit.offset, first_frame)) {
      stream_.go_past(unit, found->gof.header.num_frames, found->end);
      return loaded(unit.offset, found->end, std::move(found->gof));
    }
  }
  auto gof = read(unit);
  if (gof || gof.error().code != Errc::kLimitExceeded || cache_.is_empty()) return gof;
  cache_.clear();
  count_cached_bytes();
  return read(unit);
}

Result<std::unique_ptr<LoadedGof>> GofSource::read(const UnitHeader& unit) {
  auto access_unit = stream_.read(unit);
  if (!access_unit) return access_unit.error();
  return loaded(unit.offset, stream_.offset(),
                prepare(std::move(*access_unit), stream_.context(), rigs_,
                        options_.max_cached_bytes / 2));
}

Result<bool> GofSource::go_to(std::uint32_t frame) {
  if (auto kept = cache_.take_frame(frame)) {
    leave();
    stream_.go_to(kept->end, kept->end_frame());
    enter(std::move(kept));
    return true;
  }
  if (auto ok = stream_.seek(frame); !ok) return ok;
  return load_next();
}

void GofSource::look_ahead() {
  if (!prefetch_ || !gof_ || looked_ahead_ == direction_) return;
  const std::uint32_t first = gof_->header().first_frame;
  if (direction_ == Direction::kForward) {
    prefetch_->fill(stream_.offset(), stream_.next_first_frame(), options_.threads - 1);
  } else if (direction_ == Direction::kBack && first > 0 && !cache_.has_frame(first - 1)) {
    const auto place = stream_.locate(first - 1);
    if (place) prefetch_->ask(*place, first - 1);
  }
  looked_ahead_ = direction_;
}

Result<bool> GofSource::prefetch(std::uint32_t frame) {
  if (has_frame(frame) || cache_.has_frame(frame)) return true;
  if (prefetch_ && prefetch_->has_asked(frame)) return true;
  const auto place = stream_.locate(frame);
  if (!place) return place.error();
  if (prefetch_) {
    prefetch_->ask(*place, frame);
    return true;
  }
  if (options_.max_cached_bytes == 0) return true;
  const ThreadPool::Use use(threads_);
  const StreamReader::Place here = stream_.place();
  stream_.go_to(place->offset, place->first_frame);
  if (const auto unit = stream_.units().header_at(place->offset)) {
    if (auto gof = read(*unit)) {
      (*gof)->gof.recon->make_ready(frame - place->first_frame);
      cache_.put(std::move(*gof));
      count_cached_bytes();
    }
  }
  stream_.return_to(here);
  return true;
}

}  // namespace rlpc
