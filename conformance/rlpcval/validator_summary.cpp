// What shows only with the whole stream: a wrong index, and what is legal but surely not meant.
#include <algorithm>
#include <string>

#include "common/skinned_gof/recon/skinned_recon.h"
#include "conformance/rlpcval/validator_stream.h"

namespace rlpc {
namespace {

// Below this number of GOFs, an index saves nothing.
constexpr std::size_t kManyGofs = 16;
// Frames per second that animations have: from one in ten seconds to a thousand.
constexpr std::uint64_t kMinFrameSeconds = 10;
constexpr std::uint64_t kMaxFrameRate = 1000;

bool is_zero(const Component& component) {
  const auto all_zero = [](const std::vector<std::int32_t>& residuals) {
    return std::all_of(residuals.begin(), residuals.end(),
                       [](std::int32_t x) { return x == 0; });
  };
  return all_zero(component.temporal_residual) || all_zero(component.spatial_residual);
}

bool is_still(const Trajectory& trajectory) {
  return std::all_of(trajectory.residual.begin(), trajectory.residual.end(),
                     [](const Vec3i& residual) { return residual == Vec3i{}; });
}

template <class T>
void raise(T& most, std::uint64_t value) {
  most = std::max(most, static_cast<T>(value));
}

}  // namespace

// 7.9: the first frames and the offsets are those of the GOF units.
void StreamValidator::compare_index(const GofIndexCheck& index) {
  if (!index.readable || gap_) return;
  findings_.in_unit(index.unit);
  findings_.suspect(index.suspect || frames_suspect_);
  const std::uint64_t at = (index.unit.offset + kUnitHeaderBytes) * 8;
  const bool frames_known = index_.known_first_frames == index_.gofs.size();
  const std::size_t common = std::min(index.gofs.size(), index_.gofs.size());
  for (std::size_t g = 0; g < common; ++g) {
    const GofLocation& listed = index.gofs[g];
    const GofLocation& found = index_.gofs[g];
    if (listed.offset != found.offset) {
      return findings_.unchecked("R-IDX-03", "index_gof_bytes", at,
                                 "GOF " + std::to_string(g) + " is listed at byte " +
                                     std::to_string(listed.offset) + ", its unit is at byte " +
                                     std::to_string(found.offset));
    }
    if (frames_known && listed.first_frame != found.first_frame) {
      return findings_.unchecked("R-IDX-03", "index_gof_frames_minus1", at,
                                 "GOF " + std::to_string(g) + " is listed with first frame " +
                                     std::to_string(listed.first_frame) +
                                     ", its unit has first_frame " +
                                     std::to_string(found.first_frame));
    }
  }
  if (index.gofs.size() != index_.gofs.size()) {
    return findings_.unchecked("R-IDX-03", "num_index_gofs_minus1", at,
                               std::to_string(index.gofs.size()) + " GOFs are listed, there " +
                                   "are " + std::to_string(index_.gofs.size()) + " GOF units");
  }
  if (index.end <= index.gofs.back().offset || index.end > index.unit.offset) {
    findings_.unchecked("R-IDX-03", "index_gof_bytes", at,
                        "the last GOF is listed up to byte " + std::to_string(index.end) +
                            ", the index unit is at byte " + std::to_string(index.unit.offset));
  }
}

void StreamValidator::warn_of_gof(const UnitHeader& unit, const ClusterGof& gof) {
  std::vector<std::uint64_t> coded(gof.clusters.size(), 0);
  for (const std::uint16_t i : gof.cluster_of_vertex) {
    if (i != kSeedCluster) ++coded[i];
  }
  std::uint64_t factors = 3 * std::uint64_t{gof.seed_tracks.size()} * gof.num_frames;
  std::size_t idle_clusters = 0;
  std::size_t zero_components = 0;
  for (std::size_t i = 0; i < gof.clusters.size(); ++i) {
    const Cluster& cluster = gof.clusters[i];
    factors += cluster.components.size() * (3 * coded[i] + gof.num_frames);
    raise(needed_.max_components, cluster.components.size());
    // Without coded vertices, a cluster can still introduce seed vertices.
    const bool idle = coded[i] == 0 && (!cluster.lcf_flag || !cluster.components.empty());
    idle_clusters += idle ? 1 : 0;
    if (idle) continue;
    const auto& list = cluster.components;
    zero_components +=
        static_cast<std::size_t>(std::count_if(list.begin(), list.end(), is_zero));
  }
  raise(needed_.max_unit_bytes, unit.size);
  raise(needed_.max_gof_frames, gof.num_frames);
  raise(needed_.max_clusters, gof.clusters.size());
  raise(needed_.max_gof_values, gof.cluster_of_vertex.size() * gof.num_frames);
  raise(needed_.max_gof_factors, factors);
  const std::uint64_t at = unit.payload_offset() * 8;
  if (idle_clusters > 0) {
    findings_.warning("W-GOF-01", "cluster_idx", at,
                      std::to_string(idle_clusters) + " of " +
                          std::to_string(gof.clusters.size()) + " clusters");
  }
  if (zero_components > 0) {
    findings_.warning("W-GOF-02", "component", at,
                      std::to_string(zero_components) + " components of the GOF");
  }
}

void StreamValidator::warn_of_gof(const UnitHeader& unit, const SkinnedGof& gof) {
  std::vector<bool> in_use(gof.bones.size(), false);
  const CodedMesh& mesh = (*lead_.context.meshes)[gof.prediction];
  for (const Influences& influences : complete_influences(mesh, gof)) {
    for (const Influence& influence : influences) in_use[influence.bone] = true;
  }
  // Parents come before their children.
  for (std::size_t b = gof.bones.size(); b-- > 0;) {
    const std::int32_t parent = gof.bones[b].parent;
    if (in_use[b] && parent >= 0) in_use[static_cast<std::size_t>(parent)] = true;
  }
  const std::size_t num_vertices = gof.influences.size();
  raise(needed_.max_unit_bytes, unit.size);
  raise(needed_.max_gof_frames, gof.num_frames);
  raise(needed_.max_clusters, gof.bones.size());
  raise(needed_.max_components, gof.trajectories.size());
  raise(needed_.max_gof_values, num_vertices * gof.num_frames);
  raise(needed_.max_gof_factors,
        6 * gof.bones.size() * gof.num_frames + 3 * num_vertices +
            gof.trajectories.size() * (num_vertices + 3 * std::size_t{gof.num_frames}));
  const std::uint64_t at = unit.payload_offset() * 8;
  const auto idle = std::count(in_use.begin(), in_use.end(), false);
  if (idle > 0) {
    findings_.warning(
        "W-BON-01", "bone", at,
        std::to_string(idle) + " of " + std::to_string(gof.bones.size()) + " bones");
  }
  const auto zero = std::count_if(gof.trajectories.begin(), gof.trajectories.end(), is_still);
  if (zero > 0) {
    findings_.warning("W-SLI-01", "trajectory", at,
                      std::to_string(zero) + " trajectories of the GOF");
  }
}

void StreamValidator::warn_of_level() {
  if (findings_.failures() > 0 || !report_.complete) return;
  const SequenceHeader& h = lead_.header->header;
  for (std::uint32_t level_idc = 1; level_idc < h.level_idc; ++level_idc) {
    const Level& level = kLevels[level_idc - 1];
    if (h.num_vertices <= level.max_vertices && h.num_triangles <= level.max_triangles &&
        needed_.max_gof_frames <= level.max_gof_frames &&
        needed_.max_clusters <= level.max_clusters &&
        needed_.max_components <= level.max_components &&
        needed_.max_gof_values <= level.max_gof_values &&
        needed_.max_gof_factors <= level.max_gof_factors &&
        needed_.max_unit_bytes <= level.max_unit_bytes) {
      findings_.warning("W-LVL-01", "level_idc", lead_.header_bit_pos + 8,
                        "level_idc is " + std::to_string(h.level_idc) + ", level " +
                            std::to_string(level_idc) + " would do");
      return;
    }
  }
}

void StreamValidator::warn_of_stream() {
  findings_.suspect(findings_.failures() > 0);
  const std::uint64_t end = 8 * report_.bytes;
  if (!lead_.header || !lead_.header->usable) return;
  const FrameRate& rate = lead_.header->header.frame_rate;
  const std::uint64_t numerator = rate.numerator;
  const std::uint64_t denominator = rate.denominator;
  if (kMinFrameSeconds * numerator < denominator || numerator > kMaxFrameRate * denominator) {
    findings_.warning(
        "W-HDR-01", "frame_rate_numerator_minus1", lead_.header_bit_pos,
        std::to_string(numerator) + "/" + std::to_string(denominator) + " frames per second");
  }
  warn_of_level();
  const auto seen = [&](UnitType type) { return seen_[static_cast<std::uint8_t>(type)]; };
  const std::uint32_t gofs = seen(UnitType::kGof);
  const std::uint32_t hashes = seen(UnitType::kGofHash);
  if (gofs > hashes) {
    findings_.warning(
        "W-HSH-01", "gof_hash", end,
        std::to_string(gofs - hashes) + " of " + std::to_string(gofs) + " GOFs have no hash");
  }
  const std::uint32_t indexes = seen(UnitType::kGofIndex);
  if (gofs >= kManyGofs && indexes == 0) {
    findings_.warning("W-IDX-01", "gof_index", end, std::to_string(gofs) + " GOFs");
  }
  if (indexes > index_.units_found && ended_) {
    findings_.unchecked("R-IDX-04", "gof_index", end,
                        std::to_string(indexes - index_.units_found) + " of " +
                            std::to_string(indexes) + " GOF index units");
  }
  if (seen(UnitType::kMetadata) > 1) {
    findings_.warning("W-MET-01", "metadata", end,
                      std::to_string(seen(UnitType::kMetadata)) + " metadata units");
  }
}

}  // namespace rlpc
