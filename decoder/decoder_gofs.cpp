// GOFs of a decoder: loads, caches, finds and prefetches them.
#include <algorithm>
#include <cassert>
#include <utility>

#include "common/memory/owned.h"
#include "decoder/decoder_impl.h"

namespace rlpc {

Direction Decoder::Impl::direction_of(std::uint32_t frame) const {
  const std::uint32_t next = last_frame_ ? *last_frame_ + 1 : 0;
  if (frame == next) return Direction::kForward;
  return frame + 2 == next ? Direction::kBack : Direction::kElsewhere;
}

void Decoder::Impl::fail(const Error& error) {
  failure_ = error;
  gof_.reset();
  live_.reset();
  if (prefetch_) prefetch_->clear();
}

// Returns whether the GOF is decoded frame by frame.
Result<bool> Decoder::Impl::is_live(const UnitHeader& unit) {
  if (!stream_.header().open_end_flag) return false;
  const auto header = stream_.gof_header(unit);
  if (!header) return false;  // reading the GOF reports this error or an earlier one
  return rlpc::is_live(stream_.header(), header->kind);
}

void Decoder::Impl::leave_gof() {
  cache_.put(std::move(gof_));
  gof_.reset();
  live_.reset();
  band_.clear();
  count_cached_bytes();
}

void Decoder::Impl::count_cached_bytes() {
  const std::uint64_t of_frames = gof_ ? gof_->gof.frame_bytes : 0;
  cache_.set_max_bytes(max_cached_bytes_ - std::min(max_cached_bytes_, of_frames));
  stream_.set_cached_bytes(cache_.bytes() + of_frames);
}

void Decoder::Impl::enter(std::unique_ptr<LoadedGof> gof) {
  gof_ = std::move(gof);
  was_cut_ = was_cut_ || gof_->gof.is_cut;
  looked_ahead_.reset();
  count_cached_bytes();
}

std::unique_ptr<LoadedGof> Decoder::Impl::loaded(std::uint64_t offset, std::uint64_t end,
                                                 PreparedGof gof) {
  HashCheck check;
  if (!gof.is_cut) {
    if (!verify_hashes_) gof.frame_crcs.clear();
    check = {std::move(gof.hash), std::move(gof.frame_crcs), gof.header.num_frames};
  }
  return std::make_unique<LoadedGof>(
      LoadedGof{{}, offset, end, std::move(gof), std::move(check)});
}

Result<bool> Decoder::Impl::load_gof() {
  leave_gof();
  if (prefetch_) prefetch_->hand_over_rigs();
  const auto unit = stream_.find_gof();
  if (!unit) return unit.error();
  if (!*unit) return false;
  if (forward_only_) stream_.units().forget((*unit)->offset);
  const auto live = is_live(**unit);
  if (!live) return live;
  // Frames out of order need the whole GOF, unless an error follows them.
  if (!*live || is_random_) {
    auto gof = find_gof(**unit);
    if (gof) enter(std::move(*gof));
    if (gof || !*live) return gof ? Result<bool>(true) : Result<bool>(gof.error());
  }
  live_ = std::make_unique<LiveGof>(stream_, stream_.access_units().cut());
  return live_->begin(**unit);
}

// Returns the GOF that begins with a unit: cached, prefetched, or parsed now.
Result<std::unique_ptr<LoadedGof>> Decoder::Impl::find_gof(const UnitHeader& unit) {
  const std::uint32_t first_frame = stream_.next_first_frame();
  if (auto kept = cache_.take_at(unit.offset)) {
    stream_.go_past(unit, kept->header().num_frames, kept->end);
    return kept;
  }
  if (prefetch_) {
    if (direction_ == Direction::kForward) {
      prefetch_->fill(unit.offset, first_frame, num_threads_);
    }
    if (auto found = prefetch_->take(unit.offset, first_frame)) {
      stream_.go_past(unit, found->gof.header.num_frames, found->end);
      return loaded(unit.offset, found->end, std::move(found->gof));
    }
  }
  auto gof = read_gof(unit);
  if (gof || gof.error().code != Errc::kLimitExceeded || cache_.is_empty()) return gof;
  cache_.clear();
  count_cached_bytes();
  return read_gof(unit);
}

Result<std::unique_ptr<LoadedGof>> Decoder::Impl::read_gof(const UnitHeader& unit) {
  auto access_unit = stream_.read(unit);
  if (!access_unit) return access_unit.error();
  return loaded(
      unit.offset, stream_.offset(),
      prepare(std::move(*access_unit), stream_.context(), rigs_, max_cached_bytes_ / 2));
}

Result<bool> Decoder::Impl::go_to_gof_of(std::uint32_t frame) {
  if (auto kept = cache_.take_frame(frame)) {
    leave_gof();
    stream_.go_to(kept->end, kept->end_frame());
    enter(std::move(kept));
    return true;
  }
  if (auto ok = stream_.seek(frame); !ok) return ok;
  return load_gof();
}

Result<bool> Decoder::Impl::seek(std::uint32_t frame) {
  assert(frame < num_frames().value_or(kMaxFrames));
  const ThreadPool::Use use(threads_);
  failure_.reset();
  direction_ = direction_of(frame);
  if (!has_frame(frame)) {
    if (auto ok = go_to_gof_of(frame); !ok) {
      fail(ok.error());
      return ok;
    }
  }
  if (gof_ && frame == gof_->header().first_frame) gof_->hash_check.restart();
  position_ = frame;
  return true;
}

void Decoder::Impl::look_ahead() {
  if (!prefetch_ || !gof_ || looked_ahead_ == direction_) return;
  const std::uint32_t first = gof_->header().first_frame;
  if (direction_ == Direction::kForward) {
    prefetch_->fill(stream_.offset(), stream_.next_first_frame(), num_threads_ - 1);
  } else if (direction_ == Direction::kBack && first > 0 && !cache_.has_frame(first - 1)) {
    const auto place = stream_.locate(first - 1);
    if (place) prefetch_->ask(*place, first - 1);
  }
  looked_ahead_ = direction_;
}

Result<bool> Decoder::Impl::prefetch(std::uint32_t frame) {
  assert(frame < num_frames().value_or(kMaxFrames));
  if (has_frame(frame) || cache_.has_frame(frame)) return true;
  if (prefetch_ && prefetch_->has_asked(frame)) return true;
  const auto place = stream_.locate(frame);
  if (!place) return place.error();
  if (prefetch_) {
    prefetch_->ask(*place, frame);
    return true;
  }
  if (max_cached_bytes_ == 0) return true;
  const ThreadPool::Use use(threads_);
  const StreamReader::Place here = stream_.place();
  stream_.go_to(place->offset, place->first_frame);
  if (const auto unit = stream_.units().header_at(place->offset)) {
    if (auto gof = read_gof(*unit)) {
      (*gof)->gof.recon->make_ready(frame - place->first_frame);
      cache_.put(std::move(*gof));
      count_cached_bytes();
    }
  }
  stream_.return_to(here);
  return true;
}

Result<GofRange> Decoder::Impl::gof_of(std::uint32_t frame) {
  assert(frame < num_frames().value_or(kMaxFrames));
  if (gof_ && gof_->has_frame(frame)) {
    return GofRange{gof_->header().first_frame, gof_->header().num_frames};
  }
  const auto place = stream_.locate(frame);
  if (!place) return place.error();
  return GofRange{place->first_frame, place->num_frames};
}

Result<Vector<GofRange>> Decoder::Impl::gofs() {
  Vector<GofRange> ranges;
  const std::uint32_t end = num_frames().value_or(kMaxFrames);
  for (std::uint32_t frame = 0; frame < end;) {
    const auto gof = gof_of(frame);
    if (!gof) return gof.error();
    ranges.push_back(*gof);
    frame = gof->first_frame + gof->num_frames;
  }
  return ranges;
}

}  // namespace rlpc
