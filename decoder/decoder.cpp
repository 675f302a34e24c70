// Implements decoder/rlpc_decoder.h: goes from unit to unit, and from frame to frame.
#include <algorithm>
#include <cassert>
#include <string>
#include <utility>
#include <vector>

#include "common/mesh/topology.h"
#include "common/syntax/stream_format.h"
#include "decoder/parse/parse_cluster_gof.h"
#include "decoder/parse/parse_connectivity.h"
#include "decoder/parse/parse_end_of_sequence.h"
#include "decoder/parse/parse_gof_hash.h"
#include "decoder/parse/parse_metadata.h"
#include "decoder/parse/parse_sequence_header.h"
#include "decoder/parse/parse_skinned_gof.h"
#include "decoder/parse/parse_vertex_order.h"
#include "decoder/recon/frame_band.h"
#include "decoder/recon/frame_recon.h"
#include "decoder/recon/hash_check.h"
#include "decoder/recon/prefetch.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/stream/find_gof_index.h"
#include "decoder/stream/unit_reader.h"

namespace rlpc {
namespace {

// 6.2 CheckUnitType( expected )
// A unit where it may not stand, or a critical one that this version does not know.
Error misplaced(const UnitHeader& unit, std::uint32_t version_minor) {
  const UnitType last = version_minor > 0 ? UnitType::kSlice : UnitType::kEndOfSequence;
  const bool known =
      unit.ancillary() || (unit.type() >= UnitType::kSequenceHeader && unit.type() <= last);
  return Error{known ? Errc::kInvalid : Errc::kUnsupported, known ? "R-UNT-05" : "R-UNT-04",
               "unit_type", unit.offset * 8};
}

constexpr std::uint32_t kMaxThreads = 256;

}  // namespace

class Decoder::Impl {
 public:
  Impl(std::unique_ptr<ByteSource> source, const DecoderOptions& options)
      : units_(std::move(source), options.trace, options.limits.max_memory_bytes),
        options_(options),
        band_(std::clamp(options.threads, 1U, kMaxThreads)) {
    options_.threads = std::clamp(options.threads, 1U, kMaxThreads);
  }

  Result<bool> open();
  Result<bool> next_frame(std::span<std::int32_t> positions);
  Result<bool> seek(std::uint32_t frame);
  Result<std::uint32_t> parse_rest();

  const SequenceHeader& header() const { return header_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  bool has_vertex_order() const { return !vertex_order_.empty(); }
  const std::string& metadata() const { return metadata_; }
  std::uint32_t position() const { return position_; }
  bool was_cut() const { return was_cut_; }
  std::uint32_t compared_frames() const { return hash_check_.compared_frames(); }

 private:
  Result<bool> read_sequence_header();
  Result<bool> read_connectivity(const UnitHeader& unit);
  Result<bool> read_vertex_order(const UnitHeader& unit);
  Result<bool> read_ancillary(const UnitHeader& unit);
  Result<bool> check_limits() const;
  // Goes to the next GOF unit or to the end of the sequence, past everything in between.
  Result<bool> next_gof_unit(UnitHeader& unit);
  Result<bool> check_end(const UnitHeader& unit);
  // Of a GOF that is skipped: from its first bytes alone.
  Result<GofStart> gof_start(const UnitHeader& unit);
  // Goes past the slices of a GOF of bones that is not wanted.
  Result<bool> skip_slices();
  // Of the next GOF unit, which begins with frames_parsed_.
  void remember_gof(const UnitHeader& unit);
  Result<bool> load_gof();
  Result<bool> find_gof(const UnitHeader& unit);
  // Parses a GOF; goes past its unit and the slice units behind it.
  Result<FrameRecon> read_gof(const UnitHeader& unit);
  Result<FrameRecon> read_slices(SkinnedGofParser& parser);
  Result<bool> load_hashes();
  Result<bool> decode_frame(std::span<std::int32_t> positions);
  Result<bool> seek_gof(std::uint32_t frame);
  // Whatever is loaded may not fit the position any more.
  void fail(const Error& error) {
    failure_ = error;
    recon_.reset();
    ahead_.reset();
  }
  void to_output_order(std::span<const std::int32_t> decoded,
                       std::span<std::int32_t> positions) const;

  UnitReader units_;
  DecoderOptions options_;
  SequenceHeader header_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> vertex_order_;
  std::string metadata_;
  Topology topology_;

  std::uint64_t offset_ = kStreamHeaderBytes;  // of the next unit
  std::uint32_t frames_parsed_ = 0;            // first frame of the next GOF unit
  std::vector<GofLocation> gofs_;              // those met so far, ascending
  bool index_tried_ = false;
  bool ended_ = false;
  bool was_cut_ = false;

  std::optional<Error> failure_;                       // stands until a seek
  std::unique_ptr<MeshPredictions> mesh_predictions_;  // in the Main profile
  std::optional<FrameRecon> recon_;
  std::uint32_t gof_first_frame_ = 0;
  std::uint32_t position_ = 0;
  HashCheck hash_check_;
  FrameBand band_;
  std::optional<Prefetch> ahead_;  // with several threads
};

Result<bool> Decoder::Impl::open() {
  if (auto ok = units_.stream_header(); !ok) return ok;
  if (auto ok = read_sequence_header(); !ok) return ok;
  bool have_connectivity = false;
  for (;;) {
    const auto unit = units_.header_at(offset_);
    if (!unit) return unit.error();
    if (unit->type() == UnitType::kConnectivity && !have_connectivity) {
      if (auto ok = read_connectivity(*unit); !ok) return ok;
      have_connectivity = true;
    } else if (unit->type() == UnitType::kVertexOrder && have_connectivity &&
               !has_vertex_order()) {
      if (auto ok = read_vertex_order(*unit); !ok) return ok;
    } else if (unit->type() == UnitType::kGof && have_connectivity) {
      return true;
    } else if (auto ok = read_ancillary(*unit); !ok) {
      return ok;
    }
    offset_ = unit->end();
  }
}

// 6.3: always the first unit.
Result<bool> Decoder::Impl::read_sequence_header() {
  const auto unit = units_.header_at(offset_);
  if (!unit) return unit.error();
  if (unit->type() != UnitType::kSequenceHeader)
    return misplaced(*unit, units_.version_minor());
  const auto payload = units_.payload(*unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(*unit, *payload);
  const auto header = parse_sequence_header(r, units_.version_minor());
  if (!header) return header.error();
  header_ = *header;
  units_.set_max_unit_bytes(header_.level().max_unit_bytes);
  offset_ = unit->end();
  return check_limits();
}

Result<bool> Decoder::Impl::check_limits() const {
  const DecodeLimits& limits = options_.limits;
  const auto exceeded = [](const char* element) {
    return Error{Errc::kLimitExceeded, "", element, kStreamHeaderBytes * 8};
  };
  if (header_.num_vertices > limits.max_vertices) return exceeded("num_vertices_minus1");
  if (header_.num_triangles > limits.max_triangles) return exceeded("num_triangles");
  if (header_.num_frames > limits.max_frames) return exceeded("num_frames_minus1");
  // Connectivity, topology, in the Main profile layers, and frames, as this decoder holds
  // them.
  const std::uint64_t of_vertex =
      (header_.profile_idc == kProfileMain ? 400 : 100) + 12 * kBandFrames;
  const std::uint64_t fixed = std::uint64_t{header_.num_vertices} * of_vertex +
                              std::uint64_t{header_.num_triangles} * 120;
  if (fixed > limits.max_memory_bytes) return exceeded("num_vertices_minus1");
  return true;
}

Result<bool> Decoder::Impl::read_connectivity(const UnitHeader& unit) {
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  auto triangles = parse_connectivity(r, header_.num_vertices, header_.num_triangles);
  if (!triangles) return triangles.error();
  triangles_ = std::move(*triangles);
  topology_ = make_topology(header_.num_vertices, triangles_);
  if (header_.profile_idc == kProfileMain) {
    mesh_predictions_ = std::make_unique<MeshPredictions>(topology_, triangles_);
  }
  return true;
}

Result<bool> Decoder::Impl::read_vertex_order(const UnitHeader& unit) {
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  auto order = parse_vertex_order(r, header_.num_vertices);
  if (!order) return order.error();
  vertex_order_ = std::move(*order);
  for (Triangle& t : triangles_) {
    for (std::uint32_t& v : t) v = vertex_order_[v];
  }
  return true;
}

// Units that a decoder may skip: their CRC holds, and metadata is kept.
Result<bool> Decoder::Impl::read_ancillary(const UnitHeader& unit) {
  if (!unit.ancillary()) return misplaced(unit, units_.version_minor());
  if (unit.type() != UnitType::kMetadata) return units_.skip(unit);
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  auto json = parse_metadata(r);
  if (!json) return json.error();
  metadata_ = std::move(*json);
  return true;
}

// True: `unit` is a GOF. False: the sequence has ended as it should.
Result<bool> Decoder::Impl::next_gof_unit(UnitHeader& unit) {
  for (;;) {
    const auto next = units_.header_at(offset_);
    if (!next) return next.error();
    unit = *next;
    if (unit.type() == UnitType::kGof) return true;
    if (unit.type() == UnitType::kEndOfSequence) return check_end(unit);
    if (auto ok = read_ancillary(unit); !ok) return ok;
    offset_ = unit.end();
  }
}

// 6.8 end_of_sequence( )
Result<bool> Decoder::Impl::check_end(const UnitHeader& unit) {
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  parse_end_of_sequence(r);
  units_.flush_trace();
  if (r.error()) return *r.error();
  if (frames_parsed_ != header_.num_frames) {
    return Error{Errc::kInvalid, "R-END-01", "unit_type", unit.offset * 8};
  }
  if (unit.end() != units_.size()) {
    return Error{Errc::kInvalid, "R-END-02", "end_of_sequence", unit.end() * 8};
  }
  ended_ = true;
  return false;
}

Result<GofStart> Decoder::Impl::gof_start(const UnitHeader& unit) {
  constexpr std::uint32_t kEnough = 16;  // two codes of at most 63 bits, and a flag
  const auto bytes = units_.payload_start(unit, kEnough);
  if (!bytes) return bytes.error();
  BitReader r = units_.bits(unit, *bytes);
  const GofStart start = parse_gof_start(r, header_, frames_parsed_);
  if (r.error()) return *r.error();
  return start;
}

Result<bool> Decoder::Impl::skip_slices() {
  while (offset_ < units_.size()) {
    const auto unit = units_.header_at(offset_);
    if (!unit) return unit.error();
    if (unit->type() != UnitType::kSlice) break;
    offset_ = unit->end();
  }
  return true;
}

void Decoder::Impl::remember_gof(const UnitHeader& unit) {
  if (gofs_.empty() || gofs_.back().first_frame < frames_parsed_) {
    gofs_.push_back({unit.offset, frames_parsed_});
  }
}

// Parses the GOF unit at offset_ and the hash unit behind it.
Result<bool> Decoder::Impl::load_gof() {
  UnitHeader unit;
  const auto more = next_gof_unit(unit);
  if (!more || !*more) return more;
  if (frames_parsed_ == header_.num_frames) {
    return Error{Errc::kInvalid, "R-END-01", "unit_type", unit.offset * 8};
  }
  recon_.reset();
  band_.clear();
  if (auto ok = find_gof(unit); !ok) return ok;
  remember_gof(unit);
  gof_first_frame_ = frames_parsed_;
  frames_parsed_ += recon_->num_frames();
  was_cut_ = was_cut_ || recon_->is_cut();
  return load_hashes();
}

// The GOF of a unit, parsed ahead or now; goes past its units.
Result<bool> Decoder::Impl::find_gof(const UnitHeader& unit) {
  if (options_.threads > 1 && options_.trace == nullptr) {
    if (!ahead_) {
      ahead_.emplace(units_, header_, topology_, mesh_predictions_.get(),
                     options_.limits.max_memory_bytes / options_.threads, options_.cut);
    }
    ahead_->fill(unit.offset, frames_parsed_, options_.threads);
    if (auto parsed = ahead_->take(unit.offset, frames_parsed_)) {
      recon_ = std::move(parsed->recon);
      offset_ = parsed->end;
      ahead_->fill(offset_, frames_parsed_ + recon_->num_frames(), options_.threads - 1);
      return true;
    }
  }
  auto recon = read_gof(unit);
  if (!recon) return recon.error();
  recon_ = std::move(*recon);
  return true;
}

Result<FrameRecon> Decoder::Impl::read_gof(const UnitHeader& unit) {
  const std::uint64_t max_memory_bytes = options_.limits.max_memory_bytes;
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(unit, *payload);
  const GofStart start = parse_gof_start(r, header_, frames_parsed_);
  if (r.error()) return *r.error();
  if (start.bones_flag) {
    SkinnedGofParser parser(header_, *mesh_predictions_, max_memory_bytes, options_.cut);
    if (const auto ok = parser.bones(r, start); !ok) return ok.error();
    offset_ = unit.end();
    return read_slices(parser);
  }
  const auto gof = parse_clusters(r, header_, topology_, start, max_memory_bytes);
  if (!gof) return gof.error();
  offset_ = unit.end();
  return FrameRecon(ClusterRecon(header_, topology_, *gof));
}

Result<FrameRecon> Decoder::Impl::read_slices(SkinnedGofParser& parser) {
  while (offset_ < units_.size()) {
    const auto slice = units_.header_at(offset_);
    if (!slice) return slice.error();
    if (slice->type() != UnitType::kSlice) break;
    const auto slice_payload = units_.payload(*slice);
    if (!slice_payload) return slice_payload.error();
    BitReader slice_bits = units_.bits(*slice, *slice_payload);
    if (const auto ok = parser.slice(slice_bits, slice->offset * 8); !ok) return ok.error();
    offset_ = slice->end();
  }
  const CodedMesh& mesh = parser.mesh();
  return FrameRecon(SkinnedRecon(mesh, parser.finish(), header_.position_bits),
                    parser.is_cut());
}

// 6.7: a hash unit belongs to the GOF before it.
Result<bool> Decoder::Impl::load_hashes() {
  hash_check_ = {};
  if (!options_.verify_hashes || offset_ == units_.size()) return true;
  const auto unit = units_.header_at(offset_);
  if (!unit) return unit.error();
  if (unit->type() != UnitType::kGofHash) return true;
  const auto payload = units_.payload(*unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(*unit, *payload);
  auto hash = parse_gof_hash(r, recon_->num_frames());
  if (!hash) return hash.error();
  if (!recon_->is_cut()) hash_check_ = {std::move(*hash), recon_->num_frames()};
  offset_ = unit->end();
  return true;
}

// 8.6.1 Output order
void Decoder::Impl::to_output_order(std::span<const std::int32_t> decoded,
                                    std::span<std::int32_t> positions) const {
  if (!has_vertex_order()) {
    std::copy(decoded.begin(), decoded.end(), positions.begin());
    return;
  }
  for (std::size_t v = 0; v < vertex_order_.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) {
      positions[3 * std::size_t{vertex_order_[v]} + c] = decoded[3 * v + c];
    }
  }
}

Result<bool> Decoder::Impl::next_frame(std::span<std::int32_t> positions) {
  assert(positions.size() == 3 * std::size_t{header_.num_vertices});
  if (failure_) return *failure_;
  const auto more = decode_frame(positions);
  if (!more) fail(more.error());
  return more;
}

Result<bool> Decoder::Impl::decode_frame(std::span<std::int32_t> positions) {
  const bool loaded = recon_ && position_ < gof_first_frame_ + recon_->num_frames();
  if (!loaded) {
    if (ended_) return false;
    if (auto more = load_gof(); !more || !*more) return more;
  }
  const std::uint32_t f = position_ - gof_first_frame_;
  const auto decoded = band_.frame(*recon_, f, positions.size());
  if (!hash_check_.add_frame(f, decoded)) {
    return Error{Errc::kInvalid, "R-HSH-02", "position_crc", offset_ * 8};
  }
  to_output_order(decoded, positions);
  ++position_;
  return true;
}

Result<bool> Decoder::Impl::seek(std::uint32_t frame) {
  assert(frame < header_.num_frames);
  failure_.reset();
  const bool loaded =
      recon_ && frame >= gof_first_frame_ && frame < gof_first_frame_ + recon_->num_frames();
  if (!loaded) {
    if (auto ok = seek_gof(frame); !ok) {
      fail(ok.error());
      return ok;
    }
  }
  if (frame == gof_first_frame_) hash_check_.restart();
  position_ = frame;
  band_.begin_small();
  return true;
}

Result<bool> Decoder::Impl::seek_gof(std::uint32_t frame) {
  recon_.reset();
  band_.clear();
  ended_ = false;
  const bool met = !gofs_.empty() && frame < frames_parsed_;
  if (!met && !index_tried_) {
    auto gofs = find_gof_index(units_, offset_, header_.num_frames);
    if (!gofs) return gofs.error();
    index_tried_ = true;
    if (!gofs->empty()) gofs_ = std::move(*gofs);
  }
  const auto after =
      std::upper_bound(gofs_.begin(), gofs_.end(), frame,
                       [](std::uint32_t f, const GofLocation& g) { return f < g.first_frame; });
  if (after != gofs_.begin()) {
    offset_ = std::prev(after)->offset;
    frames_parsed_ = std::prev(after)->first_frame;
  }
  // Forward over GOFs that are not wanted: only their headers are read.
  for (;;) {
    UnitHeader unit;
    const auto more = next_gof_unit(unit);
    if (!more) return more;
    if (!*more || frames_parsed_ == header_.num_frames) {
      return Error{Errc::kInvalid, "R-END-01", "unit_type", unit.offset * 8};
    }
    const auto start = gof_start(unit);
    if (!start) return start.error();
    if (frame < frames_parsed_ + start->num_frames) break;
    remember_gof(unit);
    frames_parsed_ += start->num_frames;
    offset_ = unit.end();
    if (!start->bones_flag) continue;
    if (auto ok = skip_slices(); !ok) return ok;
  }
  return load_gof();
}

Result<std::uint32_t> Decoder::Impl::parse_rest() {
  if (failure_) return *failure_;
  while (!ended_) {
    if (const auto more = load_gof(); !more) {
      fail(more.error());
      return more.error();
    }
  }
  position_ = header_.num_frames;
  recon_.reset();
  return static_cast<std::uint32_t>(gofs_.size());
}

Result<Decoder> Decoder::open(std::unique_ptr<ByteSource> source,
                              const DecoderOptions& options) {
  auto impl = std::make_unique<Impl>(std::move(source), options);
  if (const auto ok = impl->open(); !ok) return ok.error();
  return Decoder(std::move(impl));
}

Decoder::Decoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Decoder::Decoder(Decoder&&) noexcept = default;
Decoder& Decoder::operator=(Decoder&&) noexcept = default;
Decoder::~Decoder() = default;

const SequenceHeader& Decoder::header() const { return impl_->header(); }
std::span<const Triangle> Decoder::triangles() const { return impl_->triangles(); }
bool Decoder::has_vertex_order() const { return impl_->has_vertex_order(); }
Result<bool> Decoder::next_frame(std::span<std::int32_t> positions) {
  return impl_->next_frame(positions);
}
Result<bool> Decoder::seek(std::uint32_t frame) { return impl_->seek(frame); }
const std::string& Decoder::metadata() const { return impl_->metadata(); }
Result<std::uint32_t> Decoder::parse_rest() { return impl_->parse_rest(); }
std::uint32_t Decoder::position() const { return impl_->position(); }
bool Decoder::was_cut() const { return impl_->was_cut(); }
std::uint32_t Decoder::compared_frames() const { return impl_->compared_frames(); }

}  // namespace rlpc
