#include "encoder/codec/kinds/cluster/cluster_gof_search.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/cluster/cluster_counts.h"
#include "encoder/codec/kinds/cluster/variant_search.h"
#include "encoder/codec/spans/count_at.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// tuned (off: 0): The search for the number of clusters climbs from this entry of the series 1,
// 2, 3, 4, 6, 8, 12 (count_at), so from eight clusters.
constexpr std::size_t kFirstCount = 5;
constexpr std::size_t kNumCounts = 13;  // fixed: up to 96

class ClusterSearch {
 public:
  ClusterSearch(const ClusterGofCoding& coding, double step)
      : coding_(coding), step_(step), maker_(coding.cluster_maker()) {}

  FoundClusters run() {
    if (coding_.settings().preset != Preset::kFast && has_variants(coding_.settings())) {
      FoundVariant found = search_variants(coding_, step_, choices_of_paper());
      return {found.choice, std::move(found.clustering)};
    }
    const ClusterChoice choice = choose();
    return {choice, coding_.cluster(*maker_, choice.clusters)};
  }

  FoundClusters run_near(const ClusterChoice& choice) {
    if (coding_.settings().preset == Preset::kFast) {
      return {choice, coding_.cluster(*maker_, choice.clusters)};
    }
    std::size_t start = 0;
    while (start + 1 < kNumCounts && count_at(start) < choice.clusters) ++start;
    ClusterChoice best{choose_count(choice.world, start, 1), choice.world};
    // A sample does not show that one set of components suits the whole mesh.
    const ClusterChoice one{1, true};
    if (cost(one) < cost(best)) best = one;
    return {best, coding_.cluster(*maker_, best.clusters)};
  }

 private:
  double cost(const EncodedSpan& encoded) const {
    const double error = squared_error(coding_.frames(), encoded.frame);
    const double bits = 8.0 * static_cast<double>(encoded.units[0].payload.size());
    return error + lambda(step_) * bits;
  }
  double cost(const ClusterChoice& choice) {
    return cost(coding_.encode(step_, choice, *maker_));
  }

  std::uint32_t choose_count(bool world) {
    return choose_count(world, world ? 0 : kFirstCount,
                        coding_.settings().preset == Preset::kSlow ? 1 : 2);
  }
  std::uint32_t choose_count(bool world, std::size_t start, std::size_t stride) {
    const std::size_t last = last_cluster_count(coding_.frames().num_vertices, kNumCounts);
    return count_at(climb(start, last, stride, [&](std::size_t i) {
      return cost({count_at(i), world});
    }));
  }

  ClusterChoice choose() {
    const BaselineTools& tools = coding_.settings().baseline;
    const bool world_requested = tools.frame_mode == FrameMode::kWorld;
    const bool any_frame = tools.frame_mode == FrameMode::kAuto;
    if (tools.clusters > 0 && !any_frame) return {tools.clusters, world_requested};
    const std::uint32_t usual =
        tools.clusters > 0 ? tools.clusters : usual_clusters(coding_.frames().num_vertices);
    if (coding_.settings().preset == Preset::kFast) return {usual, world_requested};
    const auto best_of = [&](bool world) {
      return ClusterChoice{tools.clusters > 0 ? tools.clusters : choose_count(world), world};
    };
    if (!any_frame) return best_of(world_requested);
    const ClusterChoice local = best_of(false);
    const ClusterChoice world = best_of(true);
    return cost(world) < cost(local) ? world : local;
  }

  // Returns the choices that the variants of the paper's method are tried with.
  std::vector<ClusterChoice> choices_of_paper() {
    const BaselineTools& tools = coding_.settings().baseline;
    if (tools.clusters == 0 || tools.frame_mode != FrameMode::kAuto) return {choose()};
    return {{tools.clusters, false}, {tools.clusters, true}};
  }

  const ClusterGofCoding& coding_;
  double step_;
  std::unique_ptr<ClusterMaker> maker_;
};

}  // namespace

FoundClusters search_clusters(const ClusterGofCoding& coding, double step) {
  return ClusterSearch(coding, step).run();
}

FoundClusters search_clusters_near(const ClusterGofCoding& coding, double step,
                                   const ClusterChoice& choice) {
  return ClusterSearch(coding, step).run_near(choice);
}

std::uint32_t usual_clusters(std::uint32_t num_vertices) {
  // tuned: The number of clusters has this many vertices to each, where it is not searched:
  // with the fast preset, and next to skinned GOFs.
  constexpr std::uint32_t kVerticesOfCluster = 56;
  constexpr std::uint32_t kFewestClusters = 2;  // fixed: the fewest that are several
  return std::clamp(num_vertices / kVerticesOfCluster, kFewestClusters,
                    count_at(kNumCounts - 1));
}

}  // namespace rlpc
