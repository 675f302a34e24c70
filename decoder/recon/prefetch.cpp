#include "decoder/recon/prefetch.h"

#include <utility>

#include "decoder/parse/parse_cluster_gof.h"
#include "decoder/recon/async.h"

namespace rlpc {

Prefetch::Prefetch(UnitReader& units, const SequenceHeader& header, const Topology& topology,
                   const MeshPredictions* meshes, std::uint64_t max_memory_bytes,
                   const SliceCut& cut)
    : units_(units),
      header_(header),
      topology_(topology),
      meshes_(meshes),
      max_memory_bytes_(max_memory_bytes),
      cut_(cut) {}

std::optional<Prefetch::Parsed> Prefetch::take(std::uint64_t offset,
                                               std::uint32_t first_frame) {
  std::optional<Parsed> parsed;
  if (!gofs_.empty()) {
    Ahead& ahead = gofs_.front();
    const GofUnits& units = ahead.units;
    if (units.gof.unit.offset == offset && units.start.first_frame == first_frame &&
        ahead.done.get() && ahead.recon) {
      parsed = Parsed{std::move(*ahead.recon), units.end()};
      gofs_.pop_front();
    }
  }
  if (!parsed) gofs_.clear();
  return parsed;
}

void Prefetch::fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count) {
  while (!gofs_.empty() && gofs_.front().units.start.first_frame != first_frame)
    gofs_.pop_front();
  if (!gofs_.empty()) {
    offset = gofs_.back().units.end();
    first_frame = gofs_.back().units.end_frame();
  }
  while (gofs_.size() < count && first_frame < header_.num_frames) {
    auto units = read(offset, first_frame);
    if (!units) return;
    offset = units->end();
    first_frame = units->end_frame();
    gofs_.push_back({std::move(*units), std::nullopt, {}});
    Ahead& ahead = gofs_.back();
    ahead.done = run_async([this, &ahead] { ahead.recon = parse(ahead.units); });
  }
}

// The next GOF, past ancillary units, if its units fit into max_memory_bytes. Nothing is read
// behind the end of the sequence.
std::optional<GofUnits> Prefetch::read(std::uint64_t offset, std::uint32_t first_frame) {
  GofUnits units;
  std::uint64_t num_bytes = 0;
  for (bool have_gof = false; offset < units_.size();) {
    const auto unit = units_.header_at(offset);
    if (!unit) return std::nullopt;
    const bool is_gof = !have_gof && unit->type() == UnitType::kGof;
    const bool is_slice = units.start.bones_flag && unit->type() == UnitType::kSlice;
    if (is_gof || is_slice) {
      num_bytes += unit->size;
      if (num_bytes > max_memory_bytes_) return std::nullopt;
      auto payload = units_.payload(*unit);
      if (!payload) return std::nullopt;
      GofUnits::Coded coded{*unit, std::move(*payload)};
      if (is_slice) {
        units.slices.push_back(std::move(coded));
      } else {
        BitReader r = units_.bits(*unit, coded.payload);
        units.start = parse_gof_start(r, header_, first_frame);
        if (r.error()) return std::nullopt;
        units.gof = std::move(coded);
        have_gof = true;
      }
    } else if (have_gof) {
      return units;
    } else if (!unit->ancillary()) {
      return std::nullopt;
    }
    offset = unit->end();
  }
  return std::nullopt;
}

std::optional<FrameRecon> Prefetch::parse(const GofUnits& units) const {
  BitReader r = units_.bits(units.gof.unit, units.gof.payload);
  const GofStart start = parse_gof_start(r, header_, units.start.first_frame);
  if (!start.bones_flag) {
    const auto gof = parse_clusters(r, header_, topology_, start, max_memory_bytes_);
    if (!gof) return std::nullopt;
    return FrameRecon(ClusterRecon(header_, topology_, *gof));
  }
  SkinnedGofParser parser(header_, *meshes_, max_memory_bytes_, cut_);
  if (!parser.bones(r, start)) return std::nullopt;
  for (const auto& [unit, payload] : units.slices) {
    BitReader slice = units_.bits(unit, payload);
    if (!parser.slice(slice, unit.offset * 8)) return std::nullopt;
  }
  const CodedMesh& mesh = parser.mesh();
  return FrameRecon(SkinnedRecon(mesh, parser.finish(), header_.position_bits),
                    parser.is_cut());
}

}  // namespace rlpc
