#include "conformance/rlpcval/validator_gofs.h"

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "common/codec/kinds/skinned/recon/skinned_recon.h"

namespace rlpc {
namespace {

bool is_zero(const Component& component) {
  const auto all_zero = [](const std::vector<std::int32_t>& residuals) {
    return std::all_of(residuals.begin(), residuals.end(),
                       [](std::int32_t x) { return x == 0; });
  };
  return all_zero(component.temporal_residual) || all_zero(component.spatial_residual);
}

template <class T>
void raise(T& max, std::uint64_t value) {
  max = std::max(max, static_cast<T>(value));
}

class GofWarnings {
 public:
  GofWarnings(const StreamContext& context, const RigSlots& rigs, std::uint64_t bit_pos,
              FindingList& findings, Level& needed)
      : context_(context), rigs_(rigs), at_(bit_pos), findings_(findings), needed_(needed) {}

  void add(const ClusterGof& gof);
  void add(const SkinnedGof& gof);
  void add(const SharedRig& rig);
  void add(const InterGof& gof);

 private:
  std::uint64_t num_vertices() const { return context_.header.num_vertices; }
  void add_rig(const SharedRig& rig);

  const StreamContext& context_;
  const RigSlots& rigs_;
  std::uint64_t at_;
  FindingList& findings_;
  Level& needed_;
};

void GofWarnings::add(const InterGof& gof) {
  raise(needed_.max_gof_values, num_vertices() * gof.num_frames);
  raise(needed_.max_clusters, gof.num_patches);
  raise(needed_.max_gof_factors, 3 * num_vertices() * gof.max_earlier_distance);
  if (gof.learning_flag) {
    raise(needed_.max_learning_vertices, num_vertices() * gof.pattern.temporal_layers);
  }
}

void GofWarnings::add(const ClusterGof& gof) {
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
    if (idle) ++idle_clusters;
    if (idle) continue;
    const auto& list = cluster.components;
    zero_components +=
        static_cast<std::size_t>(std::count_if(list.begin(), list.end(), is_zero));
  }
  raise(needed_.max_clusters, gof.clusters.size());
  raise(needed_.max_gof_values, gof.cluster_of_vertex.size() * gof.num_frames);
  raise(needed_.max_gof_factors, factors);
  if (idle_clusters > 0) {
    findings_.warning("W-GOF-01", "cluster_idx", at_,
                      std::to_string(idle_clusters) + " of " +
                          std::to_string(gof.clusters.size()) + " clusters");
  }
  if (zero_components > 0) {
    findings_.warning("W-GOF-02", "component", at_,
                      std::to_string(zero_components) + " components of the GOF");
  }
}

// Warns about the parts of a skinned GOF or shared rig that have vertices.
void GofWarnings::add_rig(const SharedRig& rig) {
  std::vector<bool> in_use(rig.bones.size(), false);
  const OrderedMesh& mesh = (*context_.meshes)[rig.prediction];
  for (const Influences& influences : complete_influences(mesh, rig)) {
    for (const Influence& influence : influences) in_use[influence.bone] = true;
  }
  // Parents come before their children.
  for (std::size_t b = rig.bones.size(); b-- > 0;) {
    const std::int32_t parent = rig.bones[b].parent;
    if (in_use[b] && parent >= 0) in_use[static_cast<std::size_t>(parent)] = true;
  }
  const std::uint64_t adaptive = rig.weights.num_adaptive_factors;
  raise(needed_.max_clusters, rig.bones.size());
  raise(needed_.max_components, std::max<std::uint64_t>(rig.trajectories.size(), adaptive));
  raise(needed_.max_adaptive_values, adaptive * num_vertices());
  const auto idle = std::count(in_use.begin(), in_use.end(), false);
  if (idle > 0) {
    findings_.warning(
        "W-BON-01", "bone", at_,
        std::to_string(idle) + " of " + std::to_string(rig.bones.size()) + " bones");
  }
}

void GofWarnings::add(const SharedRig& rig) {
  add_rig(rig);
  raise(needed_.max_gof_factors, rigs_.num_factors(kMaxRigs));
}

void GofWarnings::add(const SkinnedGof& gof) {
  std::uint64_t with_vertices = gof.trajectories.size();
  std::uint64_t factors = 3 * num_vertices();
  if (gof.rig) {
    with_vertices -= std::min(gof.trajectories.size(), gof.rig->trajectories.size());
    factors = rigs_.num_factors(kMaxRigs);
    raise(needed_.max_components, gof.trajectories.size());
  } else {
    add_rig(gof);
  }
  factors += 6 * gof.bones.size() * gof.num_frames + with_vertices * num_vertices() +
             3 * gof.trajectories.size() * gof.num_frames;
  raise(needed_.max_gof_values, num_vertices() * gof.num_frames);
  raise(needed_.max_gof_factors, factors);
  const auto zero =
      std::count_if(gof.trajectories.begin(), gof.trajectories.end(),
                    [](const Trajectory& t) { return t.trajectory_flag && is_still(t); });
  if (zero > 0) {
    findings_.warning("W-SLI-01", "trajectory", at_,
                      std::to_string(zero) + " trajectories of the GOF");
  }
}

}  // namespace

bool is_still(const Trajectory& trajectory) {
  return std::all_of(trajectory.residual.begin(), trajectory.residual.end(),
                     [](const Vec3i& residual) { return residual == Vec3i{}; });
}

void warn_of_gof(const AccessUnit& access_unit, const StreamContext& context,
                 const RigSlots& rigs, std::uint64_t bit_pos, FindingList& findings,
                 Level& needed) {
  raise(needed.max_gof_frames, access_unit.header().num_frames);
  GofWarnings warnings(context, rigs, bit_pos, findings, needed);
  std::visit([&](const auto& gof) { warnings.add(gof); }, access_unit.gof);
}

void warn_of_rig(const SharedRig& rig, const StreamContext& context, const RigSlots& rigs,
                 std::uint64_t bit_pos, FindingList& findings, Level& needed) {
  GofWarnings(context, rigs, bit_pos, findings, needed).add(rig);
}

}  // namespace rlpc
