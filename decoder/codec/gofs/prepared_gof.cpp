#include "decoder/codec/gofs/prepared_gof.h"

#include <algorithm>
#include <utility>

#include "decoder/codec/parse/memory_estimate.h"

namespace rlpc {
namespace {

// Returns the memory of the reconstructed values. Residuals are dropped after reconstruction.
std::uint64_t memory_of(const ClusterGof& gof, const SequenceHeader& header) {
  constexpr std::uint64_t kBytesPerValue = 8;  // two limbs
  constexpr std::uint64_t kBytesPerComponent = 400;
  constexpr std::uint64_t kBytesPerSeedValue = 24;
  constexpr std::uint64_t kBytesPerVertex = 16;
  std::uint64_t bytes = header.num_vertices * kBytesPerVertex +
                        gof.seed_tracks.size() * gof.num_frames * kBytesPerSeedValue;
  for (const Cluster& cluster : gof.clusters) {
    for (const Component& c : cluster.components) {
      // The vertices of a cluster take whole tiles.
      const std::uint64_t spatial = c.spatial_residual.size() + 3 * std::uint64_t{kTileValues};
      bytes += kBytesPerComponent + kBytesPerValue * (c.temporal_residual.size() + spatial);
    }
  }
  return bytes;
}

std::uint64_t memory_of(const SkinnedGof& gof, const SequenceHeader& header) {
  const std::uint64_t factors = gof.trajectories.size();
  const std::uint64_t of_tracks =
      memory_of_tracks(std::uint64_t{3} * gof.num_frames * (factors + 4 * gof.bones.size())) +
      memory_of_trajectories(factors);
  const std::uint64_t of_factors = memory_of_spatial(header.num_vertices, factors);
  if (gof.rig) return of_tracks + of_factors;
  return of_tracks + of_factors + memory_of_spatial(header.num_vertices, kRestFactors) +
         memory_of_vertices(header.num_vertices, gof.rest.order_flag);
}

std::uint64_t memory_of(const InterGof& gof, const SequenceHeader& header) {
  std::uint64_t bytes = memory_of_frames(header.num_vertices, gof.num_frames, gof);
  for (const InterFrame& frame : *gof.frames) {
    bytes += memory_of_frame(header.num_vertices, frame.residual.num_large(), gof.num_patches);
  }
  return bytes;
}

}  // namespace

PreparedGof prepare(AccessUnit access_unit, const StreamContext& context, RigRecons& rigs,
                    std::uint64_t max_frame_bytes) {
  PreparedGof gof;
  gof.recon = make_recon(access_unit, context, rigs);
  gof.header = access_unit.header();
  gof.hash = std::move(access_unit.hash);
  gof.frame_crcs = access_unit.frame_crcs();
  gof.is_cut = access_unit.is_cut;
  if (const auto* const skinned = std::get_if<SkinnedGof>(&access_unit.gof)) {
    gof.rig = skinned->rig;
  }
  gof.memory_bytes =
      std::visit([&](const auto& g) { return memory_of(g, context.header); }, access_unit.gof);
  if (gof.recon->is_ordered()) {
    const std::uint64_t of_frame = 12 * std::uint64_t{context.header.num_vertices};
    const std::uint64_t most =
        std::min<std::uint64_t>(gof.header.num_frames, max_frame_bytes / of_frame);
    gof.recon->keep_frames(static_cast<std::uint32_t>(most));
    gof.frame_bytes = most * of_frame;
    gof.memory_bytes += gof.frame_bytes;
  }
  return gof;
}

}  // namespace rlpc
