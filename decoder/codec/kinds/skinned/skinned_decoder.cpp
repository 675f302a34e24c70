#include "decoder/codec/kinds/skinned/skinned_decoder.h"

#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"
#include "decoder/codec/kinds/skinned/rig_figures.h"
#include "decoder/codec/parse/rig_memory.h"
#include "decoder/codec/recon/recon_of_kind.h"

namespace rlpc {

std::unique_ptr<GofParser> SkinnedDecoder::make_parser(const StreamContext& context,
                                                       const MemoryLimit& memory,
                                                       const SliceCut& cut) {
  return std::make_unique<SkinnedGofParser>(context.header, *context.meshes, memory, cut);
}

std::unique_ptr<GofRecon> SkinnedDecoder::make_recon(const SkinnedGof& gof,
                                                     const StreamContext& context,
                                                     RigRecons& rigs) {
  if (gof.rig) return recon_of_kind(SkinnedRecon(rigs.of(gof.rig), gof));
  return recon_of_kind(
      SkinnedRecon((*context.meshes)[gof.prediction], gof, context.header.position_bits));
}

std::uint64_t SkinnedDecoder::memory_of_gof(const SkinnedGof& gof,
                                            const SequenceHeader& header) {
  const std::uint64_t factors = gof.trajectories.size();
  const std::uint64_t tracks_of_bone = gof.stretch_flag ? 6 : 4;
  const std::uint64_t track_bytes =
      memory_of_tracks(std::uint64_t{3} * gof.num_frames *
                       (factors + tracks_of_bone * gof.bones.size())) +
      memory_of_trajectories(factors);
  const std::uint64_t factor_bytes = memory_of_spatial(header.num_vertices, factors);
  if (gof.rig) return track_bytes + factor_bytes;
  return track_bytes + factor_bytes + memory_of_spatial(header.num_vertices, kRestFactors) +
         memory_of_vertices(header.num_vertices, gof.rest.order_flag);
}

void SkinnedDecoder::add_figures(const SkinnedGof& gof, GofSummary& summary) {
  const GofFigure temporal_layers{"num_temporal_layers", "temporal layer", "temporal layers",
                                  static_cast<std::uint32_t>(gof.num_temporal_layers), true};
  if (!gof.rig) {
    add_rig_figures(gof, summary);
    summary.figures.push_back(temporal_layers);
    return;
  }
  summary.layer_group_size = gof.layer_group_size;
  summary.figures = {
      {"num_trajectories", "trajectory", "trajectories", count_of(gof.trajectories)},
      {"num_local_groups", nullptr, nullptr, gof.num_local_groups},
      {"num_slices", "slice", "slices", count_of(summary.slices)},
      temporal_layers};
}

// Groups by influences, including those that the decoder predicts for absent slices.
void SkinnedDecoder::add_groups(const SkinnedGof& gof, const StreamContext& context,
                                VertexGroups& groups) {
  const SharedRig& rig = gof.rig ? *gof.rig : gof;
  groups.kind = GroupKind::kBones;
  groups.num_groups = count_of(rig.bones);
  for (const Influences& influences :
       complete_influences((*context.meshes)[rig.prediction], rig)) {
    Influence greatest;
    for (const Influence& influence : influences) {
      const bool is_before =
          influence.weight == greatest.weight && influence.bone < greatest.bone;
      if (influence.weight > greatest.weight || is_before) greatest = influence;
    }
    groups.group_of_vertex.push_back(greatest.bone);
  }
}

}  // namespace rlpc
