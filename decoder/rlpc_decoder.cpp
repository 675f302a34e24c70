#include "decoder/rlpc_decoder.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "common/codec/bits/crc32.h"
#include "common/memory/owned.h"
#include "decoder/decoder_impl.h"

namespace rlpc {

static_assert(kBandFrames == kFramesHeld);

Decoder::Impl::Impl(std::unique_ptr<ByteSource> source, const DecoderOptions& options)
    : stream_(std::move(source), options),
      rigs_(stream_.context()),
      verify_hashes_(options.verify_hashes),
      coarse_layers_(options.coarse_layers),
      num_threads_(std::clamp(options.threads, 1U, kMaxThreads)),
      threads_(num_threads_),
      max_cached_bytes_(options.max_cached_bytes),
      cache_(options.max_cached_bytes),
      band_(num_threads_),
      forward_only_(options.forward_only) {
  stream_.rigs().when_dropped([this] { rigs_.erase_unused(); });
  // A trace follows the order of the stream.
  wants_prefetch_ = num_threads_ > 1 && options.trace == nullptr;
  const std::uint32_t others = std::max(1U, num_threads_ - 1);
  prefetch_bytes_ = options.limits.max_memory_bytes / (std::uint64_t{2} * others);
}

Result<bool> Decoder::Impl::open() {
  if (auto ok = stream_.open(); !ok) return ok;
  // Prefetching would wait for GOFs that have not arrived.
  if (wants_prefetch_ && !stream_.header().open_end_flag) {
    prefetch_.emplace(stream_, rigs_, threads_, prefetch_bytes_, max_cached_bytes_ / 2,
                      num_threads_ - 1);
  }
  if (coarse_layers_ != SliceCut::kAll) {
    coarse_.emplace(stream_.header().num_vertices, stream_.triangles(), stream_.vertex_order(),
                    coarse_layers_);
  }
  return true;
}

std::uint32_t Decoder::Impl::num_layers() const {
  if (coarse_) return coarse_->num_layers();
  const auto& meshes = stream_.context().meshes;
  return meshes ? (*meshes)[Prediction::kLayers].num_layers() : 0;
}

std::optional<std::uint32_t> Decoder::Impl::num_frames() {
  const std::uint32_t num_frames = stream_.find_num_frames();
  if (stream_.header().open_end_flag && num_frames == kMaxFrames) return std::nullopt;
  return num_frames;
}

Result<bool> Decoder::Impl::decode_live_frame(std::span<std::int32_t> positions) {
  // After a seek into the GOF, decodes and drops the frames before it.
  do {
    if (const auto more = live_->next(); !more || !*more) return more;
  } while (live_->next_frame() <= position_);
  was_cut_ = was_cut_ || live_->is_cut();
  compared_frames_ = 0;
  if (verify_hashes_ && !live_->is_cut() && live_->frame_crc()) {
    if (crc32_of_positions(live_->positions()) != live_->frame_crc()->crc) {
      return Error{Errc::kInvalid, "R-HSH-02", "frame_crc", live_->frame_crc()->bit_pos};
    }
    compared_frames_ = 1;
  }
  to_output_order(live_->positions(), positions);
  ++position_;
  return true;
}

// 8.6.1 Output order, or 8.9.8 Coarse meshes
void Decoder::Impl::to_output_order(std::span<const std::int32_t> decoded,
                                    std::span<std::int32_t> positions) const {
  const auto order = stream_.vertex_order();
  if (coarse_) {
    coarse_->pick(decoded, positions);
    return;
  }
  if (order.empty()) {
    std::copy(decoded.begin(), decoded.end(), positions.begin());
    return;
  }
  for (std::size_t v = 0; v < order.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) {
      positions[3 * std::size_t{order[v]} + c] = decoded[3 * v + c];
    }
  }
}

Result<bool> Decoder::Impl::next_frame(std::span<std::int32_t> positions) {
  assert(positions.size() == 3 * std::size_t{num_vertices()});
  if (failure_) return *failure_;
  const ThreadPool::Use use(threads_);
  direction_ = direction_of(position_);
  const auto more = decode_frame(positions);
  if (!more) fail(more.error());
  if (more && *more) {
    last_frame_ = position_ - 1;
    look_ahead();
  }
  return more;
}

Result<bool> Decoder::Impl::frame(std::uint32_t frame, std::span<std::int32_t> positions) {
  if (failure_ || frame != position_) {
    is_random_ = true;
    if (auto ok = seek(frame); !ok) return ok;
  }
  return next_frame(positions);
}

Result<bool> Decoder::Impl::decode_frame(std::span<std::int32_t> positions) {
  while (live_) {
    const auto more = decode_live_frame(positions);
    if (!more || *more) return more;
    live_.reset();
    if (auto next = load_gof(); !next || !*next) return next;
  }
  if (!has_frame(position_)) {
    if (stream_.ended()) return false;
    if (auto more = load_gof(); !more || !*more) return more;
    if (live_) return decode_frame(positions);
  }
  const std::uint32_t f = position_ - gof_->header().first_frame;
  const std::size_t frame_size = 3 * std::size_t{stream_.header().num_vertices};
  band_.turn(direction_);
  const auto decoded = band_.frame(*gof_->gof.recon, f, frame_size);
  HashCheck& check = gof_->hash_check;
  const bool agrees = check.add_frame(f, decoded);
  compared_frames_ = check.compared_frames();
  if (!agrees) {
    const auto at = check.failed_at();
    return Error{Errc::kInvalid, "R-HSH-02", at ? "frame_crc" : "position_crc",
                 at.value_or(gof_->end * 8)};
  }
  to_output_order(decoded, positions);
  ++position_;
  return true;
}

Result<std::optional<std::uint32_t>> Decoder::Impl::skip_damage() {
  gof_.reset();
  live_.reset();
  if (prefetch_) prefetch_->clear();
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
  gof_.reset();
  live_.reset();
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
  if (const auto ok = impl->open(); !ok) return ok.error();
  return Decoder(std::move(impl));
}

Decoder::Decoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;
Decoder::~Decoder() = default;

const SequenceHeader& Decoder::header() const { return impl_->stream().header(); }
std::uint32_t Decoder::num_vertices() const { return impl_->num_vertices(); }
std::span<const Triangle> Decoder::triangles() const {
  return impl_->coarse() ? impl_->coarse()->triangles() : impl_->stream().triangles();
}
std::span<const std::uint32_t> Decoder::coarse_vertices() const {
  if (!impl_->coarse()) return {};
  return impl_->coarse()->vertices();
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
