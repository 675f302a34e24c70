#include "conformance/rlpcval/validator_gofs.h"

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "common/skinned_gof/recon/skinned_recon.h"

namespace rlpc {
namespace {

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

class GofWarnings {
 public:
  GofWarnings(const StreamContext& context, std::uint64_t bit_pos, FindingList& findings,
              Level& needed)
      : context_(context), at_(bit_pos), findings_(findings), needed_(needed) {}

  void add(const ClusterGof& gof);
  void add(const SkinnedGof& gof);

 private:
  const StreamContext& context_;
  std::uint64_t at_;
  FindingList& findings_;
  Level& needed_;
};

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
    idle_clusters += idle ? 1 : 0;
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

void GofWarnings::add(const SkinnedGof& gof) {
  std::vector<bool> in_use(gof.bones.size(), false);
  const CodedMesh& mesh = (*context_.meshes)[gof.prediction];
  for (const Influences& influences : complete_influences(mesh, gof)) {
    for (const Influence& influence : influences) in_use[influence.bone] = true;
  }
  // Parents come before their children.
  for (std::size_t b = gof.bones.size(); b-- > 0;) {
    const std::int32_t parent = gof.bones[b].parent;
    if (in_use[b] && parent >= 0) in_use[static_cast<std::size_t>(parent)] = true;
  }
  const std::size_t num_vertices = gof.influences.size();
  raise(needed_.max_clusters, gof.bones.size());
  raise(needed_.max_components, gof.trajectories.size());
  raise(needed_.max_gof_values, num_vertices * gof.num_frames);
  raise(needed_.max_gof_factors,
        6 * gof.bones.size() * gof.num_frames + 3 * num_vertices +
            gof.trajectories.size() * (num_vertices + 3 * std::size_t{gof.num_frames}));
  const auto idle = std::count(in_use.begin(), in_use.end(), false);
  if (idle > 0) {
    findings_.warning(
        "W-BON-01", "bone", at_,
        std::to_string(idle) + " of " + std::to_string(gof.bones.size()) + " bones");
  }
  const auto zero = std::count_if(gof.trajectories.begin(), gof.trajectories.end(), is_still);
  if (zero > 0) {
    findings_.warning("W-SLI-01", "trajectory", at_,
                      std::to_string(zero) + " trajectories of the GOF");
  }
}

}  // namespace

void warn_of_gof(const AccessUnit& access_unit, const StreamContext& context,
                 std::uint64_t bit_pos, FindingList& findings, Level& needed) {
  raise(needed.max_gof_frames, access_unit.header().num_frames);
  GofWarnings warnings(context, bit_pos, findings, needed);
  std::visit([&](const auto& gof) { warnings.add(gof); }, access_unit.gof);
}

}  // namespace rlpc
