#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "common/crc32.h"
#include "common/gof_recon.h"
#include "common/stream_format.h"
#include "common/topology.h"
#include "decoder/parse_connectivity.h"
#include "decoder/parse_gof.h"
#include "decoder/parse_gof_hash.h"
#include "decoder/parse_gof_index.h"
#include "decoder/parse_metadata.h"
#include "decoder/parse_sequence_header.h"
#include "decoder/parse_vertex_order.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/unit_reader.h"

namespace rlpc {
namespace {

// 6.2 CheckUnitType( expected )
// A unit where it may not stand, or a critical one that this version does not know.
Error misplaced(const UnitHeader& unit) {
  const bool known = unit.ancillary() || (unit.type() >= UnitType::kSequenceHeader &&
                                          unit.type() <= UnitType::kEndOfSequence);
  return Error{known ? Errc::kInvalid : Errc::kUnsupported, known ? "R-UNT-05" : "R-UNT-04",
               "unit_type", unit.offset * 8};
}

}  // namespace

class Decoder::Impl {
 public:
  Impl(std::unique_ptr<ByteSource> source, const DecoderOptions& options)
      : units_(std::move(source), options.trace), options_(options) {}

  Result<bool> open();
  Result<bool> next_frame(std::span<std::int32_t> positions);
  Result<bool> seek(std::uint32_t frame);
  Result<std::uint32_t> parse_rest();

  const SequenceHeader& header() const { return header_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  bool has_vertex_order() const { return !vertex_order_.empty(); }
  const std::string& metadata() const { return metadata_; }
  std::uint32_t position() const { return position_; }

 private:
  Result<bool> read_sequence_header();
  Result<bool> read_connectivity(const UnitHeader& unit);
  Result<bool> read_vertex_order(const UnitHeader& unit);
  Result<bool> read_ancillary(const UnitHeader& unit);
  Result<bool> check_limits() const;
  // Goes to the next GOF unit or to the end of the sequence, past everything in between.
  Result<bool> next_gof_unit(UnitHeader& unit);
  Result<bool> check_end(const UnitHeader& unit);
  Result<bool> load_index();
  Result<std::uint32_t> gof_frames(const UnitHeader& unit);
  // Of the next GOF unit, which begins with frames_parsed_.
  void remember_gof(const UnitHeader& unit);
  Result<bool> load_gof();
  Result<bool> load_hashes();
  Result<bool> decode_frame(std::span<std::int32_t> positions);
  Result<bool> seek_gof(std::uint32_t frame);
  // Whatever is loaded may not fit the position any more.
  void fail(const Error& error) {
    failure_ = error;
    recon_.reset();
  }
  Result<bool> verify_hash(std::span<const std::int32_t> positions);
  void to_output_order(std::span<std::int32_t> positions);

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

  std::optional<Error> failure_;  // stands until a seek
  std::optional<GofRecon> recon_;
  std::uint32_t gof_first_frame_ = 0;
  std::uint32_t position_ = 0;
  std::optional<GofHash> hash_;
  std::uint32_t running_crc_ = 0;
  std::uint32_t hashed_frames_ = 0;    // consecutive frames of the GOF in running_crc_
  std::vector<std::int32_t> decoded_;  // a frame in decoded order, if the output has another
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
  if (unit->type() != UnitType::kSequenceHeader) return misplaced(*unit);
  const auto payload = units_.payload(*unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(*unit, *payload);
  const auto header = parse_sequence_header(r);
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
  // Connectivity, topology and a frame, as this decoder holds them.
  const std::uint64_t fixed =
      std::uint64_t{header_.num_vertices} * 100 + std::uint64_t{header_.num_triangles} * 120;
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
  decoded_.resize(3 * std::size_t{header_.num_vertices});
  return true;
}

// Units that a decoder may skip: their CRC holds, and metadata is kept.
Result<bool> Decoder::Impl::read_ancillary(const UnitHeader& unit) {
  if (!unit.ancillary()) return misplaced(unit);
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  if (unit.type() != UnitType::kMetadata) return true;
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
  r.u(32, "index_distance");
  r.expect_end();
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

// 6.9: GOFs that were not met yet, from the index before the end of the sequence, if there is
// one. parse_gof finds out if it is wrong.
Result<bool> Decoder::Impl::load_index() {
  index_tried_ = true;
  constexpr std::uint64_t kEndBytes = kUnitHeaderBytes + 4 + kUnitCrcBytes;
  if (units_.size() < offset_ + kEndBytes) return false;
  const auto end = units_.header_at(units_.size() - kEndBytes);
  if (!end || end->type() != UnitType::kEndOfSequence) return false;
  const auto end_payload = units_.payload(*end);
  if (!end_payload) return end_payload.error();
  const std::uint32_t distance = units_.bits(*end, *end_payload).u(32, "index_distance");
  if (distance == 0) return false;
  if (distance > end->offset) {
    return Error{Errc::kInvalid, "R-END-03", "index_distance", end->payload_offset() * 8};
  }
  const auto unit = units_.header_at(end->offset - distance);
  if (!unit) return unit.error();
  if (unit->type() != UnitType::kGofIndex || unit->end() != end->offset) {
    return Error{Errc::kInvalid, "R-END-03", "index_distance", end->payload_offset() * 8};
  }
  const auto payload = units_.payload(*unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(*unit, *payload);
  auto gofs = parse_gof_index(r, header_.num_frames);
  if (!gofs) return gofs.error();
  gofs_ = std::move(*gofs);
  return true;
}

// Number of frames of a GOF that is skipped: from its first bytes alone.
Result<std::uint32_t> Decoder::Impl::gof_frames(const UnitHeader& unit) {
  constexpr std::uint32_t kEnough = 16;  // both elements have at most 63 bits
  const auto bytes = units_.payload_start(unit, kEnough);
  if (!bytes) return bytes.error();
  BitReader r = units_.bits(unit, *bytes);
  const std::uint32_t frames = parse_gof_frames(r, header_, frames_parsed_);
  if (r.error()) return *r.error();
  return frames;
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
  const auto payload = units_.payload(unit);
  if (!payload) return payload.error();
  recon_.reset();
  BitReader r = units_.bits(unit, *payload);
  const auto gof =
      parse_gof(r, header_, topology_, frames_parsed_, options_.limits.max_memory_bytes);
  if (!gof) return gof.error();
  recon_.emplace(header_, topology_, *gof);
  remember_gof(unit);
  gof_first_frame_ = frames_parsed_;
  frames_parsed_ += gof->num_frames;
  offset_ = unit.end();
  return load_hashes();
}

// 6.7: a hash unit belongs to the GOF before it.
Result<bool> Decoder::Impl::load_hashes() {
  hash_.reset();
  running_crc_ = 0;
  hashed_frames_ = 0;
  if (!options_.verify_hashes || offset_ == units_.size()) return true;
  const auto unit = units_.header_at(offset_);
  if (!unit) return unit.error();
  if (unit->type() != UnitType::kGofHash) return true;
  const auto payload = units_.payload(*unit);
  if (!payload) return payload.error();
  BitReader r = units_.bits(*unit, *payload);
  auto hash = parse_gof_hash(r, recon_->num_frames());
  if (!hash) return hash.error();
  hash_ = std::move(*hash);
  offset_ = unit->end();
  return true;
}

// 8.6.2 Hash check. A hash of the whole GOF needs all of its frames in order.
Result<bool> Decoder::Impl::verify_hash(std::span<const std::int32_t> positions) {
  const std::uint32_t f = position_ - gof_first_frame_;
  const Error mismatch{Errc::kInvalid, "R-HSH-02", "position_crc", offset_ * 8};
  if (hash_->per_frame_flag) {
    if (crc32_of_positions(positions) != hash_->position_crc[f]) return mismatch;
    return true;
  }
  if (hashed_frames_ != f) return true;
  running_crc_ = crc32_of_positions(positions, running_crc_);
  ++hashed_frames_;
  if (hashed_frames_ == recon_->num_frames() && running_crc_ != hash_->position_crc[0]) {
    return mismatch;
  }
  return true;
}

// 8.6.1 Output order
void Decoder::Impl::to_output_order(std::span<std::int32_t> positions) {
  for (std::size_t v = 0; v < vertex_order_.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) {
      positions[3 * std::size_t{vertex_order_[v]} + c] = decoded_[3 * v + c];
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
  const std::span<std::int32_t> out = has_vertex_order() ? std::span(decoded_) : positions;
  recon_->frame(position_ - gof_first_frame_, out);
  if (hash_) {
    if (auto ok = verify_hash(out); !ok) return ok;
  }
  if (has_vertex_order()) to_output_order(positions);
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
  position_ = frame;
  return true;
}

Result<bool> Decoder::Impl::seek_gof(std::uint32_t frame) {
  recon_.reset();
  ended_ = false;
  const bool met = !gofs_.empty() && frame < frames_parsed_;
  if (!met && !index_tried_) {
    if (auto ok = load_index(); !ok) return ok;
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
    const auto frames = gof_frames(unit);
    if (!frames) return frames.error();
    if (frame < frames_parsed_ + *frames) break;
    remember_gof(unit);
    frames_parsed_ += *frames;
    offset_ = unit.end();
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

}  // namespace rlpc
