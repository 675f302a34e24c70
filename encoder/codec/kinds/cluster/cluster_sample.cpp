#include "encoder/codec/kinds/cluster/cluster_sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "encoder/codec/spans/count_at.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// tuned: Number of positions in all frames of a sample.
constexpr std::uint32_t kPositions = 60000;
constexpr std::uint32_t kMinVertices = 300;   // fixed: several clusters
constexpr std::uint32_t kMaxVertices = 1500;  // fixed: time

constexpr std::size_t kSampleCounts = 10;     // fixed: up to 32 clusters of the sample
constexpr std::size_t kFirstLocal = 4;        // fixed: six clusters, two for each region
constexpr std::uint32_t kSeedsOfCluster = 3;  // fixed: number per cluster

std::uint32_t vertices_of_sample(std::uint32_t num_vertices, std::uint32_t num_frames) {
  const std::uint32_t max = std::clamp(kPositions / num_frames, kMinVertices, kMaxVertices);
  return std::min(max, std::max(num_vertices / 2, kMinVertices));
}

SequenceHeader header_of(SequenceHeader header, const MeshSample& sample) {
  header.num_vertices = static_cast<std::uint32_t>(sample.vertices.size());
  header.num_triangles = static_cast<std::uint32_t>(sample.triangles.size());
  return header;
}

}  // namespace

// Climbs from a number of clusters while the cost falls.
struct ClusterSample::Search {
  const ClusterGofCoding& coding;
  double step;
  std::unique_ptr<ClusterMaker> maker = coding.cluster_maker();

  Estimate run(bool world) {
    std::array<std::optional<SpanCost>, kSampleCounts> known;
    const auto cost_at = [&](std::size_t i) -> const SpanCost& {
      if (!known[i]) {
        known[i] = cost_of(coding.encode(step, {count_at(i), world}, *maker), coding.frames());
      }
      return *known[i];
    };
    const std::uint32_t max = coding.frames().num_vertices / kSeedsOfCluster;
    std::size_t last = kSampleCounts - 1;
    while (last > 0 && count_at(last) > max) --last;
    std::size_t best = world ? 0 : std::min(kFirstLocal, last);
    for (const bool up : {true, false}) {
      for (std::size_t i = best; up ? i < last : i > 0;) {
        i = up ? i + 1 : i - 1;
        if (ratio_at_equal_error(cost_at(i), cost_at(best)) >= 1.0) break;
        best = i;
      }
    }
    return {{count_at(best), world}, cost_at(best)};
  }
};

ClusterSample::ClusterSample(const SequenceMesh& mesh, const EncoderSettings& settings,
                             const SpanFrames& frames)
    : num_vertices_(frames.num_vertices),
      sample_(sample_mesh(frames, mesh.triangles,
                          vertices_of_sample(num_vertices_, frames.num_frames))),
      frames_(sample_.frames_of(frames, {0, frames.num_frames})),
      header_(header_of(mesh.header, sample_)),
      topology_(make_topology(frames_.num_vertices, sample_.triangles)),
      mesh_{header_, topology_, sample_.triangles},
      coding_(mesh_, settings, frames_) {}

ClusterSample::Estimate ClusterSample::cheapest(double step) const {
  Search search{coding_, step};
  Estimate best = search.run(false);
  if (const Estimate world = search.run(true);
      ratio_at_equal_error(world.cost, best.cost) < 1.0) {
    best = world;
  }
  const double scale = static_cast<double>(num_vertices_) / frames_.num_vertices;
  best.cost.bits *= scale;
  best.cost.squared_error *= scale;
  best.choice.clusters =
      std::clamp(static_cast<std::uint32_t>(std::lround(scale * best.choice.clusters)), 1U,
                 header_.level().max_clusters);
  return best;
}

}  // namespace rlpc
