#include "encoder/codec/sequence/stream_assembly.h"

#include <optional>
#include <utility>

#include "common/codec/syntax/stream_format.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/write/write_stream.h"

namespace rlpc {
namespace {

constexpr std::size_t kMinIndexedGofs = 16;  // fixed: below, an index saves a reader nothing

Bytes header_unit(const SequenceHeader& header) {
  return write_unit(UnitType::kSequenceHeader, write_sequence_header(header));
}

}  // namespace

StreamAssembly::StreamAssembly(const SequenceHeader& header, const EncoderSettings& settings,
                               const ConnectivityCode& connectivity)
    : profile_idc_(header.profile_idc),
      is_open_ended_(header.open_end_flag),
      connectivity_(write_unit(UnitType::kConnectivity, connectivity.payload)),
      end_bytes_(
          write_unit(UnitType::kEndOfSequence,
                     write_end_of_sequence(
                         0, header.open_end_flag ? std::optional(kMaxFrames) : std::nullopt))
              .size()) {
  if (!settings.metadata.empty()) {
    metadata_ = write_unit(UnitType::kMetadata, write_metadata(settings.metadata));
  }
  if (!settings.clips.empty()) {
    clip_table_ = write_unit(UnitType::kClipTable, write_clip_table(settings.clips));
  }
  if (!settings.asset.empty()) {
    asset_ = write_unit(UnitType::kAsset, write_asset(settings.asset));
  }
  if (settings.keep_order) {
    vertex_order_ =
        write_unit(UnitType::kVertexOrder, write_vertex_order(connectivity.input_vertex));
  }
  lead_bytes_ = write_stream_header(header.profile_idc).size() + header_unit(header).size() +
                metadata_.size() + clip_table_.size() + connectivity_.size() +
                vertex_order_.size() + asset_.size();
}

void StreamAssembly::set_attributes(std::span<const std::uint8_t> payload) {
  lead_bytes_ -= attributes_.size();
  attributes_.clear();
  if (!payload.empty()) {
    attributes_ = write_unit(UnitType::kAttributes, Bytes(payload.begin(), payload.end()));
  }
  lead_bytes_ += attributes_.size();
}

bool StreamAssembly::has_index(const GofIndexEntries& index) {
  return index.gofs.size() >= kMinIndexedGofs && index.fits();
}

Bytes StreamAssembly::index_unit(const GofIndexEntries& index) const {
  if (!has_index(index)) return {};
  return write_unit(UnitType::kGofIndex, write_gof_index(index, profile_idc_));
}

std::uint64_t StreamAssembly::index_bytes(std::vector<GofEntry> gofs) const {
  return index_unit({lead_bytes_, std::move(gofs), {}}).size();
}

bool StreamAssembly::put(std::span<const std::uint8_t> bytes, const ByteSink& sink) {
  written_ += bytes.size();
  return bytes.empty() || sink(bytes);
}

bool StreamAssembly::write_lead(const SequenceHeader& header, const ByteSink& sink) {
  return put(write_stream_header(header.profile_idc), sink) && put(header_unit(header), sink) &&
         put(metadata_, sink) && put(clip_table_, sink) && put(connectivity_, sink) &&
         put(vertex_order_, sink) && put(attributes_, sink) && put(asset_, sink);
}

bool StreamAssembly::write_gof(const GofBytes& gof, const ByteSink& sink) {
  gof_bytes_ += gof.rig.size() + gof.units.size();
  hash_bytes_ += gof.hash_unit.size();
  if (!gof.rig.empty()) index_.rigs.push_back({kRigIdx, written_});
  const std::uint64_t offset = written_ + gof.rig.size();
  if (index_.gofs.empty()) {
    index_.first_gof_offset = offset;
  } else {
    index_.gofs.back().bytes = offset - gof_offset_;
  }
  gof_offset_ = offset;
  layer_bytes_.push_back(gof.layer_bytes);
  index_.gofs.push_back({gof.num_frames, gof.units.size() + gof.hash_unit.size()});
  num_frames_ += gof.num_frames;
  return put(gof.rig, sink) && put(gof.units, sink) && put(gof.hash_unit, sink);
}

bool StreamAssembly::begin_gof(const Bytes& gof_unit, const ByteSink& sink) {
  return write_gof({0, {}, gof_unit, {}, true, {}}, sink);
}

bool StreamAssembly::add_to_gof(const Bytes& unit, const ByteSink& sink) {
  gof_bytes_ += unit.size();
  index_.gofs.back().bytes += unit.size();
  return put(unit, sink);
}

void StreamAssembly::end_gof(std::uint32_t num_frames) {
  index_.gofs.back().num_frames = num_frames;
  num_frames_ += num_frames;
}

bool StreamAssembly::write_end(const ByteSink& sink) {
  const Bytes index = index_unit(index_);
  index_unit_bytes_ = index.size();
  const auto index_distance = static_cast<std::uint32_t>(index.size());
  return put(index, sink) &&
         put(write_unit(UnitType::kEndOfSequence,
                        write_end_of_sequence(index_distance, is_open_ended_
                                                                  ? std::optional(num_frames_)
                                                                  : std::nullopt)),
             sink);
}

// Counts bytes as SubStreamExtractor writes them: hashes keep their size, and offsets in the
// index shrink.
std::uint64_t StreamAssembly::cut_bytes(std::size_t layers) const {
  GofIndexEntries index = index_;
  std::uint64_t removed = 0;
  auto rig = index.rigs.begin();
  std::uint64_t offset = index_.first_gof_offset;  // offset of the GOF in the whole stream
  for (std::size_t g = 0; g < index.gofs.size(); ++g) {
    // A shared rig comes before the first GOF that uses it.
    for (; rig != index.rigs.end() && rig->offset < offset; ++rig) {
      rig->offset -= removed;
    }
    std::uint64_t gof_bytes = 0;
    for (std::size_t layer = layers; layer <= layer_bytes_[g].size(); ++layer) {
      gof_bytes += layer_bytes_[g][layer - 1];
    }
    offset += index.gofs[g].bytes;
    index.gofs[g].bytes -= gof_bytes;
    removed += gof_bytes;
  }
  return written_ - removed - index_unit_bytes_ + index_unit(index).size();
}

void StreamAssembly::describe(const SequenceHeader& header,
                              const ConnectivityCode& connectivity,
                              EncodeReport& report) const {
  report.header = header;
  report.header.num_frames = num_frames_;
  report.bytes = written_;
  report.bpvf = bits_per_vertex_per_frame(written_, header.num_vertices, num_frames_);
  report.bits.connectivity = 8 * connectivity_.size();
  report.bits.vertex_order = 8 * vertex_order_.size();
  report.bits.metadata = 8 * (metadata_.size() + clip_table_.size());
  report.bits.attributes = 8 * attributes_.size();
  report.bits.asset = 8 * asset_.size();
  report.bits.gofs = 8 * gof_bytes_;
  report.bits.hashes = 8 * hash_bytes_;
  report.bits.headers = 8 * written_ - report.bits.gofs - report.bits.hashes -
                        report.bits.connectivity - report.bits.vertex_order -
                        report.bits.metadata - report.bits.attributes - report.bits.asset;
  report.num_gofs = static_cast<std::uint32_t>(index_.gofs.size());
  report.input_vertex = connectivity.input_vertex;
}

}  // namespace rlpc
