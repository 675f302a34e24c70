#include "decoder/extract/sub_stream_extractor.h"

#include <algorithm>
#include <utility>

#include "common/bitstream/crc32.h"
#include "decoder/parse/sequence/json_text.h"
#include "decoder/parse/sequence/parse_metadata.h"
#include "decoder/recon/gof_recon.h"

namespace rlpc {
namespace {

// 8.6.2: hashes of the positions of an access unit, one per frame or one for the GOF.
std::vector<std::uint32_t> position_crcs(const AccessUnit& access_unit,
                                         const StreamContext& context, bool per_frame) {
  const auto recon = make_recon(access_unit, context);
  std::vector<std::int32_t> positions(3 * std::size_t{context.header.num_vertices});
  std::vector<std::uint32_t> crcs;
  std::uint32_t crc = 0;
  const std::uint32_t num_frames = recon->num_frames();
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    recon->frame(f, positions);
    crc = crc32_of_positions(positions, per_frame ? 0 : crc);
    if (per_frame || f + 1 == num_frames) crcs.push_back(crc);
  }
  return crcs;
}

Result<std::vector<GofSummary>> check_gofs(StreamReader& stream) {
  std::vector<GofSummary> gofs;
  for (;;) {
    const auto access_unit = stream.next();
    if (!access_unit) return access_unit.error();
    if (!*access_unit) return gofs;
    const std::optional<GofHash>& hash = (*access_unit)->hash;
    if (hash && position_crcs(**access_unit, stream.context(), hash->per_frame_flag) !=
                    hash->position_crc) {
      return Error{Errc::kInvalid, "R-HSH-02", "position_crc", stream.offset() * 8};
    }
    gofs.push_back(summarise(**access_unit));
  }
}

// 7.10: the requirements on metadata that decoding does not check.
Result<bool> check_metadata(UnitReader& units) {
  for (std::uint64_t offset = kStreamHeaderBytes; offset < units.size();) {
    const auto unit = units.header_at(offset);
    if (!unit) return unit.error();
    offset = unit->end();
    if (unit->type() != UnitType::kMetadata) continue;
    const auto payload = units.payload(*unit);
    if (!payload) return payload.error();
    BitReader r = units.bits(*unit, *payload);
    const auto json = parse_metadata(r);
    if (!json) return json.error();
    if (find_json_error(*json)) {
      return Error{Errc::kInvalid, "R-MET-03", "metadata_json",
                   unit->payload_offset() * 8 + 32};
    }
  }
  return true;
}

DecoderOptions with_cut(DecoderOptions options, const SliceCut& cut) {
  options.cut = cut;
  return options;
}

}  // namespace

SubStreamExtractor::SubStreamExtractor(std::unique_ptr<StreamReader> stream,
                                       const DecoderOptions& options,
                                       std::vector<GofSummary> gofs)
    : stream_(std::move(stream)),
      cut_units_(stream_->units(), stream_->context(), options),
      cut_(options.cut),
      gofs_(std::move(gofs)) {}

Result<SubStreamExtractor> SubStreamExtractor::open(std::unique_ptr<ByteSource> source,
                                                    const SliceCut& cut,
                                                    const DecodeLimits& limits) {
  DecoderOptions options;
  options.limits = limits;
  std::uint64_t& left = options.limits.max_memory_bytes;
  left -= std::min(left, source->memory_bytes());
  auto stream = std::make_unique<StreamReader>(std::move(source), options);
  if (const auto ok = stream->open(); !ok) return ok.error();
  auto gofs = check_gofs(*stream);
  if (!gofs) return gofs.error();
  if (const auto ok = check_metadata(stream->units()); !ok) return ok.error();
  return SubStreamExtractor(std::move(stream), with_cut(options, cut), std::move(*gofs));
}

bool SubStreamExtractor::cuts_any() const {
  return std::any_of(gofs_.begin(), gofs_.end(),
                     [this](const GofSummary& gof) { return cuts(gof); });
}

Result<Bytes> SubStreamExtractor::next() {
  if (offset_ == 0) {
    offset_ = written_ = kStreamHeaderBytes;
    return write_stream_header(header().profile_idc);
  }
  while (offset_ < size()) {
    auto bytes = next_unit();
    if (!bytes) return bytes.error();
    written_ += bytes->size();
    if (!bytes->empty()) return bytes;
  }
  return Bytes{};
}

// The bytes that replace a unit; empty if it is dropped.
Result<Bytes> SubStreamExtractor::next_unit() {
  const auto unit = stream_->units().header_at(offset_);
  if (!unit) return unit.error();
  offset_ = unit->end();
  switch (unit->type()) {
    case UnitType::kGof:
      return gof(*unit);
    case UnitType::kSlice:
    case UnitType::kGofHash:
      return access_unit_ ? slice_or_hash(*unit) : Bytes{};
    case UnitType::kGofIndex:
      access_unit_.reset();
      has_index_ = true;
      return Bytes{};
    case UnitType::kEndOfSequence:
      return end_of_sequence();
    default:
      access_unit_.reset();
      return copy(*unit);
  }
}

Result<Bytes> SubStreamExtractor::copy(const UnitHeader& unit) {
  const auto payload = stream_->units().payload(unit);
  if (!payload) return payload.error();
  return write_unit(unit.type(), *payload);
}

Result<Bytes> SubStreamExtractor::gof(const UnitHeader& unit) {
  if (index_.empty()) {
    first_gof_offset_ = written_;
  } else {
    index_.back().bytes = written_ - gof_offset_;
  }
  gof_offset_ = written_;
  const GofSummary& gof = gofs_[num_gofs_++];
  index_.push_back({gof.num_frames, 0});
  access_unit_ = {unit, &gof, gof.groups_that_stay(cut_)};
  return copy(unit);
}

Result<Bytes> SubStreamExtractor::slice_or_hash(const UnitHeader& unit) {
  if (unit.type() == UnitType::kSlice) {
    const SliceEntry& slice = access_unit_->gof->slices[access_unit_->num_slices++];
    return access_unit_->groups.have(slice) ? copy(unit) : Bytes{};
  }
  auto bytes = cuts(*access_unit_->gof) ? new_hash() : copy(unit);
  access_unit_.reset();
  return bytes;
}

// 8.6.2 Hash check, of the same kind as in the input
Result<Bytes> SubStreamExtractor::new_hash() {
  const auto access_unit = cut_units_.read(access_unit_->unit, access_unit_->gof->first_frame);
  if (!access_unit) return access_unit.error();
  const bool per_frame = access_unit->hash->per_frame_flag;
  return write_unit(
      UnitType::kGofHash,
      write_gof_hash(position_crcs(*access_unit, stream_->context(), per_frame), per_frame));
}

// Includes the GOF index if the input had one and its offsets fit (R-IDX-02).
Bytes SubStreamExtractor::end_of_sequence() {
  constexpr std::uint64_t kMost = 0xFFFFFFFE;
  index_.back().bytes = written_ - gof_offset_;
  const bool fits = first_gof_offset_ <= kMost &&
                    std::all_of(index_.begin(), index_.end(),
                                [](const GofEntry& gof) { return gof.bytes <= kMost; });
  Bytes bytes;
  if (has_index_ && fits) {
    bytes = write_unit(UnitType::kGofIndex, write_gof_index(first_gof_offset_, index_));
  }
  const Bytes end = write_unit(UnitType::kEndOfSequence,
                               write_end_of_sequence(static_cast<std::uint32_t>(bytes.size())));
  bytes.insert(bytes.end(), end.begin(), end.end());
  return bytes;
}

}  // namespace rlpc
