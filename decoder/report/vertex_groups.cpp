#include "decoder/report/vertex_groups.h"

#include <algorithm>
#include <cstddef>
#include <variant>

#include "common/codec/kinds/skinned/recon/rig_recon.h"

namespace rlpc {
namespace {

void add_kind(const ClusterGof& gof, const StreamContext&, VertexGroups& groups) {
  groups.kind = GroupKind::kClusters;
  groups.num_groups = static_cast<std::uint32_t>(gof.clusters.size());
  groups.of_vertex.assign(gof.cluster_of_vertex.begin(), gof.cluster_of_vertex.end());
  for (std::size_t i = gof.clusters.size(); i-- > 0;) {  // the first cluster last
    if (!gof.clusters[i].lcf_flag) continue;
    const auto& seed = gof.clusters[i].seed_vertex;
    for (const std::uint32_t v : seed) groups.of_vertex[v] = static_cast<std::uint32_t>(i);
    groups.seeds.push_back(seed);
  }
  std::reverse(groups.seeds.begin(), groups.seeds.end());
}

// Adds groups by influences, including those that the decoder predicts for absent slices.
void add_kind(const SkinnedGof& gof, const StreamContext& context, VertexGroups& groups) {
  const SharedRig& rig = gof.rig ? *gof.rig : gof;
  groups.kind = GroupKind::kBones;
  groups.num_groups = static_cast<std::uint32_t>(rig.bones.size());
  for (const Influences& influences :
       complete_influences((*context.meshes)[rig.prediction], rig)) {
    Influence greatest;
    for (const Influence& influence : influences) {
      const bool is_before =
          influence.weight == greatest.weight && influence.bone < greatest.bone;
      if (influence.weight > greatest.weight || is_before) greatest = influence;
    }
    groups.of_vertex.push_back(greatest.bone);
  }
}

void add_kind(const InterGof& gof, const StreamContext&, VertexGroups& groups) {
  if (gof.num_patches == 0) return;
  groups.kind = GroupKind::kPatches;
  groups.num_groups = gof.num_patches;
  groups.of_vertex.assign(gof.patch_of_vertex.begin(), gof.patch_of_vertex.end());
}

}  // namespace

VertexGroups vertex_groups(const AccessUnit& access_unit, const StreamContext& context) {
  VertexGroups groups;
  groups.first_frame = access_unit.header().first_frame;
  groups.num_frames = access_unit.header().num_frames;
  std::visit([&](const auto& gof) { add_kind(gof, context, groups); }, access_unit.gof);
  return groups;
}

}  // namespace rlpc
