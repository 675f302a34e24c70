#include "decoder/rlpc_decoder.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "common/codec/bits/crc32.h"
#include "common/memory/owned.h"
#include "decoder/decoder_impl.h"

namespace rlpc {

Decoder::Impl::Impl(std::unique_ptr<ByteSource> source, const DecoderOptions& options)
    : stream_(std::move(source), options),
      threads_(std::clamp(options.threads, 1U, kMaxThreads)),
      gofs_(stream_, threads_, std::clamp(options.threads, 1U, kMaxThreads), options),
      output_(stream_) {}

Result<bool> Decoder::Impl::open(std::uint32_t coarse_layers) {
  if (auto ok = stream_.open(); !ok) return ok;
  gofs_.open();
  if (coarse_layers != SliceCut::kAll) output_.use_coarse_mesh(coarse_layers);
  return true;
}

std::uint32_t Decoder::Impl::num_layers() const {
  if (output_.coarse()) return output_.coarse()->num_layers();
  const auto& meshes = stream_.context().meshes;
  return meshes ? (*meshes)[Prediction::kLayers].num_layers() : 0;
}

std::optional<std::uint32_t> Decoder::Impl::num_frames() {
  const std::uint32_t num_frames = stream_.find_num_frames();
  if (stream_.header().open_end_flag && num_frames == kMaxFrames) return std::nullopt;
  return num_frames;
}

Direction Decoder::Impl::direction_of(std::uint32_t frame) const {
  const std::uint32_t next = last_frame_ ? *last_frame_ + 1 : 0;
  if (frame == next) return Direction::kForward;
  return frame + 2 == next ? Direction::kBack : Direction::kElsewhere;
}

void Decoder::Impl::fail(const Error& error) {
  failure_ = error;
  gofs_.drop();
}

Result<bool> Decoder::Impl::decode_live_frame(std::span<std::int32_t> positions) {
  LiveGof& live = *gofs_.live();
  // After a seek into the GOF, those before it only pass.
  do {
    if (const auto more = live.next(); !more || !*more) return more;
  } while (live.next_frame() <= position_);
  was_cut_ = was_cut_ || live.is_cut();
  compared_frames_ = 0;
  if (gofs_.verifies_hashes() && !live.is_cut() && live.frame_crc()) {
    if (crc32_of_positions(live.positions()) != live.frame_crc()->crc) {
      return Error{Errc::kInvalid, "R-HSH-02", "frame_crc", live.frame_crc()->bit_pos};
    }
    compared_frames_ = 1;
  }
  output_.to_output(live.positions(), positions, 3);
  ++position_;
  return true;
}

Result<bool> Decoder::Impl::next_frame(std::span<std::int32_t> positions) {
  assert(positions.size() == 3 * std::size_t{output_.num_vertices()});
  if (failure_) return *failure_;
  const ThreadPool::Use use(threads_);
  gofs_.turn(direction_of(position_));
  const auto more = decode_frame(positions);
  if (!more) fail(more.error());
  if (more && *more) {
    last_frame_ = position_ - 1;
    gofs_.look_ahead();
  }
  return more;
}

Result<bool> Decoder::Impl::frame(std::uint32_t frame, std::span<std::int32_t> positions) {
  if (failure_ || frame != position_) {
    gofs_.expect_any_order();
    if (auto ok = seek(frame); !ok) return ok;
  }
  return next_frame(positions);
}

Result<bool> Decoder::Impl::decode_frame(std::span<std::int32_t> positions) {
  while (gofs_.live() != nullptr) {
    const auto more = decode_live_frame(positions);
    if (!more || *more) return more;
    gofs_.leave_live();
    if (auto next = gofs_.load_next(); !next || !*next) return next;
  }
  if (!gofs_.has_frame(position_)) {
    if (stream_.ended()) return false;
    if (auto more = gofs_.load_next(); !more || !*more) return more;
    if (gofs_.live() != nullptr) return decode_frame(positions);
  }
  LoadedGof& gof = *gofs_.gof();
  const std::uint32_t f = position_ - gof.header().first_frame;
  const auto decoded = gofs_.frame(f);
  const bool agrees = gof.hash_check.add_frame(f, decoded);
  compared_frames_ = gof.hash_check.compared_frames();
  if (!agrees) {
    const auto at = gof.hash_check.failed_at();
    return Error{Errc::kInvalid, "R-HSH-02", at ? "frame_crc" : "position_crc",
                 at.value_or(gof.end * 8)};
  }
  output_.to_output(decoded, positions, 3);
  ++position_;
  return true;
}

Result<bool> Decoder::Impl::seek(std::uint32_t frame) {
  assert(frame < num_frames().value_or(kMaxFrames));
  const ThreadPool::Use use(threads_);
  failure_.reset();
  gofs_.turn(direction_of(frame));
  if (!gofs_.has_frame(frame)) {
    if (auto ok = gofs_.go_to(frame); !ok) {
      fail(ok.error());
      return ok;
    }
  }
  LoadedGof* const gof = gofs_.gof();
  if (gof != nullptr && frame == gof->header().first_frame) gof->hash_check.restart();
  position_ = frame;
  return true;
}

Result<bool> Decoder::Impl::prefetch(std::uint32_t frame) {
  assert(frame < num_frames().value_or(kMaxFrames));
  return gofs_.prefetch(frame);
}

Result<GofRange> Decoder::Impl::gof_of(std::uint32_t frame) {
  assert(frame < num_frames().value_or(kMaxFrames));
  if (const LoadedGof* const gof = gofs_.gof(); gof != nullptr && gof->has_frame(frame)) {
    return GofRange{gof->header().first_frame, gof->header().num_frames};
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

Result<std::optional<std::uint32_t>> Decoder::Impl::skip_damage() {
  gofs_.drop();
  const auto frame = stream_.skip_damage();
  if (!frame) {
    fail(frame.error());
    return frame.error();
  }
  if (!*frame) return *frame;
  failure_.reset();
  position_ = **frame;
  return *frame;
}

Result<std::uint32_t> Decoder::Impl::parse_rest() {
  if (failure_) return *failure_;
  gofs_.drop_current();
  while (!stream_.ended()) {
    const auto access_unit = stream_.next();
    if (!access_unit) {
      fail(access_unit.error());
      return access_unit.error();
    }
    was_cut_ = was_cut_ || (*access_unit && (*access_unit)->is_cut);
  }
  position_ = stream_.next_first_frame();
  return stream_.num_gofs();
}

Result<Decoder> Decoder::open(std::unique_ptr<ByteSource> source,
                              const DecoderOptions& options) {
  assert(options.coarse_layers > 0 && options.cut.max_temporal_layers > 0);
  DecoderOptions for_rest = options;
  std::uint64_t& left = for_rest.limits.max_memory_bytes;
  left -= std::min(left, source->memory_bytes());
  auto impl = std::make_unique<Impl>(std::move(source), for_rest);
  if (const auto ok = impl->open(options.coarse_layers); !ok) return ok.error();
  return Decoder(std::move(impl));
}

Decoder::Decoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;
Decoder::~Decoder() = default;

const SequenceHeader& Decoder::header() const { return impl_->stream().header(); }
std::uint32_t Decoder::num_vertices() const { return impl_->output().num_vertices(); }
std::span<const Triangle> Decoder::triangles() const { return impl_->output().triangles(); }
std::span<const std::uint32_t> Decoder::coarse_vertices() const {
  const auto& coarse = impl_->output().coarse();
  if (!coarse) return {};
  return coarse->vertices();
}
std::uint32_t Decoder::num_layers() const { return impl_->num_layers(); }
bool Decoder::has_vertex_order() const { return !impl_->stream().vertex_order().empty(); }
Result<String> Decoder::asset() { return impl_->asset(); }
bool Decoder::has_asset() const { return impl_->stream().asset_unit().has_value(); }
bool Decoder::has_attributes() const { return impl_->stream().attribute_unit().has_value(); }
Result<Vector<AttributeSet>> Decoder::attributes() { return impl_->attributes(); }
std::optional<SkeletonPose> Decoder::pose() { return impl_->pose(); }
Result<bool> Decoder::next_frame(std::span<std::int32_t> positions) {
  return impl_->next_frame(positions);
}
std::optional<std::uint32_t> Decoder::num_frames() const { return impl_->num_frames(); }
Result<bool> Decoder::seek(std::uint32_t frame) { return impl_->seek(frame); }
Result<bool> Decoder::frame(std::uint32_t frame, std::span<std::int32_t> positions) {
  return impl_->frame(frame, positions);
}
DecoderMemory Decoder::memory() const { return impl_->memory(); }
Result<bool> Decoder::prefetch(std::uint32_t frame) { return impl_->prefetch(frame); }
Result<GofRange> Decoder::gof_of(std::uint32_t frame) { return impl_->gof_of(frame); }
Result<Vector<GofRange>> Decoder::gofs() { return impl_->gofs(); }
const String& Decoder::metadata() const { return impl_->stream().metadata(); }
const Vector<Error>& Decoder::damaged_units() const { return impl_->stream().damaged_units(); }
const Vector<Clip>& Decoder::clips() const { return impl_->stream().clips(); }
Result<std::optional<std::uint32_t>> Decoder::skip_damage() { return impl_->skip_damage(); }
Result<std::uint32_t> Decoder::parse_rest() { return impl_->parse_rest(); }
std::uint32_t Decoder::position() const { return impl_->position(); }
bool Decoder::was_cut() const { return impl_->was_cut(); }
std::uint32_t Decoder::compared_frames() const { return impl_->compared_frames(); }

}  // namespace rlpc
