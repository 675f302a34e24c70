#include "decoder/extract/sub_stream_extractor.h"

#include <algorithm>
#include <utility>

#include "common/bitstream/crc32.h"
#include "decoder/parse/parse_gof_hash.h"
#include "decoder/parse/sequence/parse_vertex_order.h"

namespace rlpc {
namespace {

// One stream for several readers.
class SharedSource final : public ByteSource {
 public:
  explicit SharedSource(std::shared_ptr<ByteSource> source) : source_(std::move(source)) {}
  std::uint64_t size() const override { return source_->size(); }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    return source_->read(offset, out);
  }
  std::uint64_t memory_bytes() const override { return source_->memory_bytes(); }

 private:
  std::shared_ptr<ByteSource> source_;
};

}  // namespace

SubStreamExtractor::SubStreamExtractor(std::unique_ptr<ByteSource> units, Decoder decoder,
                                       const SliceCut& cut, std::vector<GofSummary> gofs)
    : units_(std::move(units), nullptr),
      decoder_(std::move(decoder)),
      cut_(cut),
      gofs_(std::move(gofs)),
      cuts_any_(std::any_of(gofs_.begin(), gofs_.end(),
                            [this](const GofSummary& gof) { return cuts(gof); })) {}

Result<SubStreamExtractor> SubStreamExtractor::open(std::unique_ptr<ByteSource> source,
                                                    const SliceCut& cut,
                                                    const DecodeLimits& limits) {
  const std::shared_ptr<ByteSource> shared = std::move(source);
  DecoderOptions options;
  options.limits = limits;
  StreamReader whole(std::make_unique<SharedSource>(shared), options);
  if (const auto ok = whole.open(); !ok) return ok.error();
  auto gofs = summarise_all(whole);
  if (!gofs) return gofs.error();
  options.verify_hashes = false;
  options.cut = cut;
  auto decoder = Decoder::open(std::make_unique<SharedSource>(shared), options);
  if (!decoder) return decoder.error();
  return SubStreamExtractor(std::make_unique<SharedSource>(shared), std::move(*decoder), cut,
                            std::move(*gofs));
}

Result<Bytes> SubStreamExtractor::next() {
  if (offset_ == 0) {
    offset_ = written_ = kStreamHeaderBytes;
    if (const auto ok = units_.stream_header(); !ok) return ok.error();
    return write_stream_header(header().profile_idc);
  }
  while (offset_ < units_.size()) {
    const auto unit = units_.header_at(offset_);
    if (!unit) return unit.error();
    offset_ = unit->end();
    const auto payload = units_.payload(*unit);
    if (!payload) return payload.error();
    auto bytes =
        cuts_any_ ? cut_unit(*unit, *payload) : Result(write_unit(unit->type(), *payload));
    if (!bytes) return bytes.error();
    written_ += bytes->size();
    if (!bytes->empty()) return bytes;
  }
  return Bytes{};
}

// What is in the place of a unit; nothing if it is left out.
Result<Bytes> SubStreamExtractor::cut_unit(const UnitHeader& unit, const Bytes& payload) {
  const GofSummary* const before = std::exchange(gof_, nullptr);
  switch (unit.type()) {
    case UnitType::kVertexOrder: {
      BitReader r = units_.bits(unit, payload);
      auto order = parse_vertex_order(r, header().num_vertices);
      if (!order) return order.error();
      vertex_order_ = std::move(*order);
      break;
    }
    case UnitType::kGof:
      start_gof();
      break;
    case UnitType::kSlice:
      gof_ = before;
      if (!groups_.have(gof_->slices[num_slices_++])) return Bytes{};
      break;
    case UnitType::kGofHash:
      if (before != nullptr && cuts(*before)) return new_hash(*before, unit, payload);
      break;
    case UnitType::kGofIndex:
      has_index_ = true;
      return Bytes{};
    case UnitType::kEndOfSequence:
      return end_of_sequence();
    default:
      break;
  }
  return write_unit(unit.type(), payload);
}

void SubStreamExtractor::start_gof() {
  if (index_.empty()) {
    first_gof_offset_ = written_;
  } else {
    index_.back().bytes = written_ - gof_offset_;
  }
  gof_offset_ = written_;
  gof_ = &gofs_[num_gofs_++];
  groups_ = gof_->groups_that_stay(cut_);
  num_slices_ = 0;
  index_.push_back({gof_->num_frames, 0});
}

// 8.6.2 Hash check, of the same kind as before
Result<Bytes> SubStreamExtractor::new_hash(const GofSummary& gof, const UnitHeader& unit,
                                           const Bytes& payload) {
  BitReader r = units_.bits(unit, payload);
  const auto old = parse_gof_hash(r, gof.num_frames);
  if (!old) return old.error();
  if (decoder_.position() != gof.first_frame) {
    if (const auto ok = decoder_.seek(gof.first_frame); !ok) return ok.error();
  }
  std::vector<std::int32_t> positions(3 * std::size_t{header().num_vertices});
  std::vector<std::int32_t> decoded(positions.size());
  std::vector<std::uint32_t> crcs;
  std::uint32_t crc = 0;
  for (std::uint32_t f = 0; f < gof.num_frames; ++f) {
    if (const auto more = decoder_.next_frame(positions); !more) return more.error();
    for (std::size_t v = 0; v < vertex_order_.size(); ++v) {
      std::copy_n(&positions[3 * std::size_t{vertex_order_[v]}], 3, &decoded[3 * v]);
    }
    crc = crc32_of_positions(vertex_order_.empty() ? positions : decoded,
                             old->per_frame_flag ? 0 : crc);
    if (old->per_frame_flag || f + 1 == gof.num_frames) crcs.push_back(crc);
  }
  return write_unit(UnitType::kGofHash, write_gof_hash(crcs, old->per_frame_flag));
}

// With the GOF index, if there was one.
Bytes SubStreamExtractor::end_of_sequence() {
  Bytes bytes;
  if (has_index_) {
    index_.back().bytes = written_ - gof_offset_;
    bytes = write_unit(UnitType::kGofIndex, write_gof_index(first_gof_offset_, index_));
  }
  const Bytes end = write_unit(UnitType::kEndOfSequence,
                               write_end_of_sequence(static_cast<std::uint32_t>(bytes.size())));
  bytes.insert(bytes.end(), end.begin(), end.end());
  return bytes;
}

}  // namespace rlpc
