#include "decoder/codec/extract/sub_stream_extractor.h"

#include <algorithm>
#include <utility>

#include "common/codec/bits/crc32.h"
#include "common/json/json_text.h"
#include "decoder/codec/gofs/make_recon.h"
#include "decoder/codec/parse/attributes/parse_attributes.h"
#include "decoder/codec/parse/sequence/parse_metadata.h"

namespace rlpc {
namespace {

// 8.6.2: returns hashes of the positions of an access unit, one per frame or one for the GOF.
std::vector<std::uint32_t> position_crcs(const AccessUnit& access_unit,
                                         const StreamContext& context, RigRecons& rigs,
                                         bool per_frame) {
  const auto recon = make_recon(access_unit, context, rigs);
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

Result<StreamSummary> check_gofs(StreamReader& stream) {
  RigRecons rigs(stream.context());
  return summarise_all(stream, [&](const AccessUnit& access_unit) -> std::optional<Error> {
    const std::optional<GofHash>& hash = access_unit.hash;
    if (!hash || position_crcs(access_unit, stream.context(), rigs, hash->per_frame_flag) ==
                     hash->position_crc) {
      return std::nullopt;
    }
    return Error{Errc::kInvalid, "R-HSH-02", "position_crc", stream.offset() * 8};
  });
}

// 7.10: checks requirements on metadata that decoding does not check.
Result<bool> check_metadata(UnitReader& units, const MemoryLimit& memory) {
  for (std::uint64_t offset = kStreamHeaderBytes; offset < units.size();) {
    const auto unit = units.header_at(offset);
    if (!unit) return unit.error();
    offset = unit->end();
    if (unit->type() != UnitType::kMetadata) continue;
    const auto payload = units.payload(*unit);
    if (!payload) return payload.error();
    BitReader r = units.bits(*unit, *payload);
    const auto json = parse_metadata(r, memory);
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
                                       const DecoderOptions& options, StreamSummary summary)
    : stream_(std::move(stream)),
      cut_reader_(std::make_unique<CutReader>(*stream_, options)),
      cut_(options.cut),
      summary_(std::move(summary)) {}

Result<SubStreamExtractor> SubStreamExtractor::open(std::unique_ptr<ByteSource> source,
                                                    const SliceCut& cut,
                                                    const DecodeLimits& limits) {
  DecoderOptions options;
  options.limits = limits;
  std::uint64_t& left = options.limits.max_memory_bytes;
  left -= std::min(left, source->memory_bytes());
  auto stream = std::make_unique<StreamReader>(std::move(source), options);
  if (const auto ok = stream->open(); !ok) return ok.error();
  auto summary = check_gofs(*stream);
  if (!summary) return summary.error();
  if (const auto ok = check_metadata(stream->units(), stream->access_units().memory_limit());
      !ok)
    return ok.error();
  return SubStreamExtractor(std::move(stream), with_cut(options, cut), std::move(*summary));
}

bool SubStreamExtractor::cuts_any() const {
  const auto& [rigs, gofs] = summary_;
  return std::any_of(rigs.begin(), rigs.end(),
                     [this](const auto& rig) { return rig->is_cut_by(cut_); }) ||
         std::any_of(gofs.begin(), gofs.end(),
                     [this](const GofSummary& gof) { return gof.is_cut_by(cut_); });
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

// Returns the bytes that replace a unit; empty if it is dropped.
Result<Bytes> SubStreamExtractor::next_unit() {
  const auto unit = stream_->units().header_at(offset_);
  if (!unit) return unit.error();
  offset_ = unit->end();
  switch (unit->type()) {
    case UnitType::kRig:
      return rig(*unit);
    case UnitType::kGof:
      return gof(*unit);
    case UnitType::kSlice:
    case UnitType::kFrame:
      return slice(*unit);
    case UnitType::kGofHash:
      return hash(*unit);
    case UnitType::kGofIndex:
      open_.reset();
      has_index_ = true;
      return Bytes{};
    case UnitType::kEndOfSequence:
      return end_of_sequence();
    case UnitType::kAttributes:
      open_.reset();
      return attributes(*unit);
    default:
      open_.reset();
      return copy(*unit);
  }
}

Result<Bytes> SubStreamExtractor::copy(const UnitHeader& unit) {
  const auto payload = stream_->units().payload(unit);
  if (!payload) return payload.error();
  return write_unit(unit.type(), *payload);
}

Result<Bytes> SubStreamExtractor::attributes(const UnitHeader& unit) {
  const auto payload = stream_->units().payload(unit);
  if (!payload) return payload.error();
  BitReader r = stream_->units().bits(unit, *payload);
  if (!cuts_first_frame() || !attributes_use_positions(r)) return copy(unit);
  drops_attributes_ = true;
  return Bytes{};
}

// In a GOF with frame units, no frame depends on a frame of a higher temporal layer, and the
// first frame is in layer 0.
bool SubStreamExtractor::cuts_first_frame() const {
  if (summary_.gofs.empty()) return false;
  const GofSummary& gof = summary_.gofs.front();
  SliceCut cut = cut_;
  if (slice_type(gof.kind) == UnitType::kFrame) cut.max_temporal_layers = SliceCut::kAll;
  return gof.is_cut_by(cut) || (gof.rig && gof.rig->is_cut_by(cut));
}

Result<Bytes> SubStreamExtractor::gof(const UnitHeader& unit) {
  if (index_.gofs.empty()) {
    index_.first_gof_offset = written_;
  } else {
    index_.gofs.back().bytes = written_ - gof_offset_;
  }
  gof_offset_ = written_;
  const GofSummary& gof = summary_.gofs[num_gofs_++];
  index_.gofs.push_back({gof.num_frames, 0});
  open_ = {unit, &gof, &gof, gof.groups_that_stay(cut_)};
  return copy(unit);
}

Result<Bytes> SubStreamExtractor::rig(const UnitHeader& unit) {
  if (const auto ok = cut_reader_->rigs.read(unit); !ok) return ok.error();
  const RigSummary& rig = *summary_.rigs[num_rigs_++];
  index_.rigs.push_back({rig.rig_idx, written_});
  open_ = {unit, &rig, nullptr, rig.groups_that_stay(cut_)};
  return copy(unit);
}

// Copies or drops a slice. check_gofs() has checked that it may be dropped.
Result<Bytes> SubStreamExtractor::slice(const UnitHeader& unit) {
  const SliceEntry& entry = open_->summary->slices[open_->num_slices++];
  return open_->groups.have(entry) ? copy(unit) : Bytes{};
}

Result<Bytes> SubStreamExtractor::hash(const UnitHeader& unit) {
  if (!open_ || open_->gof == nullptr) return Bytes{};
  const bool is_cut = open_->gof->is_cut_by(cut_);
  if (is_cut && is_live(stream_->header(), open_->gof->kind)) return Bytes{};  // not allowed
  auto bytes = is_cut ? new_hash() : copy(unit);
  open_.reset();
  return bytes;
}

// 8.6.2 Hash check, of the same kind as in the input
Result<Bytes> SubStreamExtractor::new_hash() {
  const auto rigs = cut_reader_->rigs.at(open_->unit.offset);
  if (!rigs) return rigs.error();
  const auto access_unit = cut_reader_->units.read(open_->unit, open_->gof->first_frame, *rigs);
  if (!access_unit) return access_unit.error();
  const bool per_frame = access_unit->hash->per_frame_flag;
  return write_unit(UnitType::kGofHash,
                    write_gof_hash(position_crcs(*access_unit, stream_->context(),
                                                 cut_reader_->recons, per_frame),
                                   per_frame));
}

// Includes the GOF index if the input had one and its offsets fit (R-IDX-02).
Bytes SubStreamExtractor::end_of_sequence() {
  index_.gofs.back().bytes = written_ - gof_offset_;
  Bytes bytes;
  if (has_index_ && index_.fits()) {
    bytes =
        write_unit(UnitType::kGofIndex, write_gof_index(index_, stream_->header().profile_idc));
  }
  std::optional<std::uint32_t> frames;
  if (stream_->header().open_end_flag) frames = num_frames();
  const Bytes end =
      write_unit(UnitType::kEndOfSequence,
                 write_end_of_sequence(static_cast<std::uint32_t>(bytes.size()), frames));
  bytes.insert(bytes.end(), end.begin(), end.end());
  return bytes;
}

}  // namespace rlpc
