// Implements Decoder (decoder/rlpc_decoder.h): iterates over access units and their frames.
#include <algorithm>
#include <cassert>
#include <string>
#include <utility>
#include <vector>

#include "common/attributes/recon/attribute_recon.h"
#include "common/bitstream/crc32.h"
#include "common/parallel/for_each.h"
#include "decoder/parse/attributes/parse_attributes.h"
#include "decoder/parse/sequence/parse_asset.h"
#include "decoder/recon/coarse_output.h"
#include "decoder/recon/frame_band.h"
#include "decoder/recon/hash_check.h"
#include "decoder/recon/live_gof.h"
#include "decoder/recon/prefetch.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/stream/stream_reader.h"

namespace rlpc {
namespace {

static_assert(kBandFrames == kFramesHeld);

}  // namespace

class Decoder::Impl {
 public:
  Impl(std::unique_ptr<ByteSource> source, const DecoderOptions& options)
      : stream_(std::move(source), options),
        models_(stream_.context()),
        verify_hashes_(options.verify_hashes),
        coarse_layers_(options.coarse_layers),
        num_threads_(std::clamp(options.threads, 1U, kMaxThreads)),
        threads_(num_threads_),
        band_(num_threads_) {
    stream_.models().when_dropped([this] { models_.erase_unused(); });
    // A trace follows the order of the stream.
    wants_prefetch_ = num_threads_ > 1 && options.trace == nullptr;
    prefetch_bytes_ = options.limits.max_memory_bytes / num_threads_;
    forward_only_ = options.forward_only;
  }

  Result<bool> open();
  Result<bool> next_frame(std::span<std::int32_t> positions);
  Result<bool> seek(std::uint32_t frame);
  Result<std::optional<std::uint32_t>> skip_damage();
  Result<std::uint32_t> parse_rest();
  Result<std::string> asset();
  Result<std::vector<AttributeSet>> attributes();

  const StreamReader& stream() const { return stream_; }
  const std::optional<CoarseOutput>& coarse() const { return coarse_; }
  std::uint32_t num_vertices() const {
    return coarse_ ? static_cast<std::uint32_t>(coarse_->vertices().size())
                   : stream_.header().num_vertices;
  }
  std::uint32_t num_layers() const;
  std::optional<std::uint32_t> num_frames();
  std::optional<SkeletonPose> pose();
  std::uint32_t position() const { return position_; }
  bool was_cut() const { return was_cut_; }
  std::uint32_t compared_frames() const { return compared_frames_; }

 private:
  bool has_frame(std::uint32_t frame) const {
    if (live_) return live_->may_have(frame);
    return gof_ && frame >= gof_->header.first_frame &&
           frame - gof_->header.first_frame < gof_->header.num_frames;
  }
  // False at the end of the sequence.
  Result<bool> load_gof();
  Result<PreparedGof> find_gof(const UnitHeader& unit);
  Result<bool> is_live(const UnitHeader& unit);
  // Of the whole mesh, uncut, in decoded order; then goes on where it was.
  Result<std::vector<std::int32_t>> first_frame();
  Result<std::vector<std::int32_t>> decode_first_frame();
  // False after the last frame of the GOF.
  Result<bool> decode_live_frame(std::span<std::int32_t> positions);
  Result<bool> decode_frame(std::span<std::int32_t> positions);
  // The loaded GOF may no longer match the position.
  void fail(const Error& error) {
    failure_ = error;
    gof_.reset();
    live_.reset();
    if (prefetch_) prefetch_->clear();
  }
  void to_output_order(std::span<const std::int32_t> decoded,
                       std::span<std::int32_t> positions) const;

  StreamReader stream_;
  ModelRecons models_;
  bool verify_hashes_;
  std::uint32_t coarse_layers_;
  std::optional<CoarseOutput> coarse_;
  std::uint32_t num_threads_;
  ThreadPool threads_;
  std::optional<PreparedGof> gof_;
  std::unique_ptr<LiveGof> live_;  // instead of gof_
  HashCheck hash_check_;
  FrameBand band_;
  bool wants_prefetch_ = false;
  std::uint64_t prefetch_bytes_ = 0;
  bool forward_only_ = false;
  std::optional<Prefetch> prefetch_;
  std::optional<Error> failure_;  // sticky until a successful seek
  std::uint32_t position_ = 0;
  bool was_cut_ = false;
  std::uint32_t compared_frames_ = 0;
  std::shared_ptr<const Skeleton> skeleton_;        // the last one
  std::optional<std::uint32_t> gof_with_skeleton_;  // its first frame
};

Result<bool> Decoder::Impl::open() {
  if (auto ok = stream_.open(); !ok) return ok;
  // Prefetching would wait for GOFs that are yet to come.
  if (wants_prefetch_ && !stream_.header().open_end_flag) {
    prefetch_.emplace(stream_, models_, threads_, prefetch_bytes_);
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

// Whether the GOF is decoded frame by frame.
Result<bool> Decoder::Impl::is_live(const UnitHeader& unit) {
  if (!stream_.header().open_end_flag) return false;
  const auto header = stream_.gof_header(unit);
  if (!header) return false;  // reading the GOF finds the error, or another before it
  return rlpc::is_live(stream_.header(), header->kind);
}

Result<bool> Decoder::Impl::decode_live_frame(std::span<std::int32_t> positions) {
  // After a seek into the GOF, those before it only pass.
  do {
    if (const auto more = live_->next(); !more || !*more) return more;
  } while (live_->next_frame() <= position_);
  was_cut_ = was_cut_ || live_->is_cut();
  compared_frames_ = 0;
  if (verify_hashes_ && !live_->is_cut() && live_->frame_crc()) {
    compared_frames_ = 1;
    if (crc32_of_positions(live_->positions()) != live_->frame_crc()->crc) {
      return Error{Errc::kInvalid, "R-HSH-02", "frame_crc", live_->frame_crc()->bit_pos};
    }
  }
  to_output_order(live_->positions(), positions);
  ++position_;
  return true;
}

Result<bool> Decoder::Impl::load_gof() {
  gof_.reset();
  live_.reset();
  band_.clear();
  if (prefetch_) prefetch_->hand_over_models();
  const auto unit = stream_.find_gof();
  if (!unit) return unit.error();
  if (!*unit) return false;
  if (forward_only_) stream_.units().forget((*unit)->offset);
  const auto live = is_live(**unit);
  if (!live) return live;
  if (*live) {
    live_ = std::make_unique<LiveGof>(stream_, stream_.access_units().cut());
    return live_->begin(**unit);
  }
  auto gof = find_gof(**unit);
  if (!gof) return gof.error();
  gof_ = std::move(*gof);
  was_cut_ = was_cut_ || gof_->is_cut;
  hash_check_ = {};
  if (!gof_->is_cut) {
    if (!verify_hashes_) gof_->frame_crcs.clear();
    hash_check_ = {std::move(gof_->hash), std::move(gof_->frame_crcs), gof_->header.num_frames};
  }
  return true;
}

// The GOF that begins with a unit, prefetched or parsed now.
Result<PreparedGof> Decoder::Impl::find_gof(const UnitHeader& unit) {
  const std::uint32_t first_frame = stream_.next_first_frame();
  if (prefetch_) {
    prefetch_->fill(unit.offset, first_frame, num_threads_);
    if (auto found = prefetch_->take(unit.offset, first_frame)) {
      stream_.go_past(unit, found->gof.header.num_frames, found->end);
      prefetch_->fill(stream_.offset(), stream_.next_first_frame(), num_threads_ - 1);
      return std::move(found->gof);
    }
  }
  auto access_unit = stream_.read(unit);
  if (!access_unit) return access_unit.error();
  return prepare(std::move(*access_unit), stream_.context(), models_);
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
  const auto more = decode_frame(positions);
  if (!more) fail(more.error());
  return more;
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
  const std::uint32_t f = position_ - gof_->header.first_frame;
  const std::size_t frame_size = 3 * std::size_t{stream_.header().num_vertices};
  const auto decoded = band_.frame(*gof_->recon, f, frame_size);
  const bool agrees = hash_check_.add_frame(f, decoded);
  compared_frames_ = hash_check_.compared_frames();
  if (!agrees) {
    const auto at = hash_check_.failed_at();
    return Error{Errc::kInvalid, "R-HSH-02", at ? "frame_crc" : "position_crc",
                 at.value_or(stream_.offset() * 8)};
  }
  to_output_order(decoded, positions);
  ++position_;
  return true;
}

std::optional<SkeletonPose> Decoder::Impl::pose() {
  if (!gof_ || position_ == 0 || !has_frame(position_ - 1)) return std::nullopt;
  const std::uint32_t first = gof_->header.first_frame;
  if (gof_with_skeleton_ != first) {
    std::optional<Skeleton> skeleton = gof_->recon->skeleton();
    if (!skeleton) return std::nullopt;
    // The place of each decoded vertex in the output.
    std::vector<std::int32_t> decoded(3 * std::size_t{stream_.header().num_vertices});
    for (std::size_t i = 0; i < decoded.size(); ++i) {
      decoded[i] = static_cast<std::int32_t>(i / 3);
    }
    std::vector<std::int32_t> in_output(3 * std::size_t{num_vertices()});
    to_output_order(decoded, in_output);
    std::vector<std::vector<SkeletonInfluence>> influences;
    for (std::size_t v = 0; v < num_vertices(); ++v) {
      influences.push_back(skeleton->influences[static_cast<std::size_t>(in_output[3 * v])]);
    }
    skeleton->influences = std::move(influences);
    if (!skeleton_ || *skeleton_ != *skeleton)
      skeleton_ = std::make_shared<const Skeleton>(std::move(*skeleton));
    gof_with_skeleton_ = first;
  }
  return SkeletonPose{skeleton_, gof_->recon->places(position_ - 1 - first),
                      gof_->recon->values_of_frame()};
}

Result<bool> Decoder::Impl::seek(std::uint32_t frame) {
  assert(frame < num_frames().value_or(kMaxFrames));
  const ThreadPool::Use use(threads_);
  failure_.reset();
  if (!has_frame(frame)) {
    auto ok = stream_.seek(frame);
    if (ok) ok = load_gof();
    if (!ok) {
      fail(ok.error());
      return ok;
    }
  }
  if (gof_ && frame == gof_->header.first_frame) hash_check_.restart();
  position_ = frame;
  band_.begin_small();
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

Result<std::vector<std::int32_t>> Decoder::Impl::decode_first_frame() {
  if (auto ok = stream_.seek(0); !ok) return ok.error();
  const auto unit = stream_.find_gof();
  if (!unit) return unit.error();
  std::vector<std::int32_t> positions(3 * std::size_t{stream_.header().num_vertices});
  const auto live = is_live(**unit);
  if (!live) return live.error();
  if (*live) {
    LiveGof gof(stream_, {});
    if (auto ok = gof.begin(**unit); !ok) return ok.error();
    if (auto ok = gof.next(); !ok) return ok.error();
    positions.assign(gof.positions().begin(), gof.positions().end());
    return positions;
  }
  auto access_unit = stream_.read(**unit);
  if (!access_unit) return access_unit.error();
  make_recon(*access_unit, stream_.context(), models_)->frame(0, positions);
  return positions;
}

Result<std::vector<std::int32_t>> Decoder::Impl::first_frame() {
  const ThreadPool::Use use(threads_);
  const SliceCut cut = stream_.access_units().cut();
  const std::uint32_t position = position_;
  gof_.reset();
  live_.reset();
  if (prefetch_) prefetch_->clear();
  stream_.access_units().set_cut({});
  auto positions = decode_first_frame();
  stream_.access_units().set_cut(cut);
  // At the end, the last frame has been decoded.
  const std::uint32_t last = num_frames().value_or(kMaxFrames) - 1;
  if (auto ok = seek(std::min(position, last)); !ok && positions) return ok.error();
  position_ = position;
  return positions;
}

Result<std::string> Decoder::Impl::asset() {
  const auto& unit = stream_.asset_unit();
  if (!unit) return std::string();
  const auto payload = stream_.units().payload(*unit);
  if (!payload) return payload.error();
  BitReader r = stream_.units().bits(*unit, *payload);
  return parse_asset(r, stream_.access_units().memory_limit());
}

Result<std::vector<AttributeSet>> Decoder::Impl::attributes() {
  const auto& unit = stream_.attribute_unit();
  if (!unit || coarse_) return std::vector<AttributeSet>();
  const auto payload = stream_.units().payload(*unit);
  if (!payload) return payload.error();
  BitReader r = stream_.units().bits(*unit, *payload);
  // Triangles in decoded order.
  std::vector<Triangle> triangles(stream_.triangles().begin(), stream_.triangles().end());
  const auto order = stream_.vertex_order();
  std::vector<std::uint32_t> decoded(order.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) decoded[order[v]] = v;
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = order.empty() ? v : decoded[v];
  }
  const std::uint32_t num_vertices = stream_.header().num_vertices;
  const auto coded =
      parse_attributes(r, num_vertices, triangles, stream_.access_units().memory_limit());
  if (!coded) return coded.error();
  std::vector<std::int32_t> positions;
  if (coded->uses_positions()) {
    auto first = first_frame();
    if (!first) return first.error();
    positions = std::move(*first);
    if (crc32_of_positions(positions) != coded->first_frame_crc) {
      return Error{Errc::kInvalid, "R-ATT-08", "first_frame_crc", unit->payload_offset() * 8};
    }
  }
  auto sets = recon_attributes(*coded, num_vertices, triangles, positions);
  for (AttributeSet& set : sets) {
    if (set.header.domain != AttributeDomain::kVertex || order.empty()) continue;
    const std::vector<std::uint32_t> values = set.values;
    const std::size_t n = set.header.num_components;
    for (std::size_t v = 0; v < order.size(); ++v) {
      for (std::size_t c = 0; c < n; ++c) set.values[order[v] * n + c] = values[v * n + c];
    }
  }
  return sets;
}

Result<Decoder> Decoder::open(std::unique_ptr<ByteSource> source,
                              const DecoderOptions& options) {
  assert(options.coarse_layers > 0);
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
Result<std::string> Decoder::asset() { return impl_->asset(); }
bool Decoder::has_attributes() const { return impl_->stream().attribute_unit().has_value(); }
Result<std::vector<AttributeSet>> Decoder::attributes() { return impl_->attributes(); }
Result<bool> Decoder::next_frame(std::span<std::int32_t> positions) {
  return impl_->next_frame(positions);
}
std::optional<SkeletonPose> Decoder::pose() { return impl_->pose(); }
std::optional<std::uint32_t> Decoder::num_frames() const { return impl_->num_frames(); }
Result<bool> Decoder::seek(std::uint32_t frame) { return impl_->seek(frame); }
const std::string& Decoder::metadata() const { return impl_->stream().metadata(); }
const std::vector<Clip>& Decoder::clips() const { return impl_->stream().clips(); }
Result<std::optional<std::uint32_t>> Decoder::skip_damage() { return impl_->skip_damage(); }
Result<std::uint32_t> Decoder::parse_rest() { return impl_->parse_rest(); }
std::uint32_t Decoder::position() const { return impl_->position(); }
bool Decoder::was_cut() const { return impl_->was_cut(); }
std::uint32_t Decoder::compared_frames() const { return impl_->compared_frames(); }

}  // namespace rlpc
