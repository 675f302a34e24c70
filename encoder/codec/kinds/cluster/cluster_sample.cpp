#include "encoder/codec/kinds/cluster/cluster_sample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "encoder/codec/kinds/cluster/cluster_counts.h"
#include "encoder/codec/spans/count_at.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// tuned: Number of positions in all frames of a sample.
constexpr std::uint32_t kPositions = 60000;
constexpr std::uint32_t kMaxVertices = 1500;  // fixed: time

constexpr std::size_t kSampleCounts = 10;  // fixed: up to 32 clusters of the sample
constexpr std::size_t kFirstLocal = 4;     // fixed: six clusters, two for each region

SequenceHeader header_of(SequenceHeader header, const MeshSample& sample) {
  header.num_vertices = static_cast<std::uint32_t>(sample.vertices.size());
  header.num_triangles = static_cast<std::uint32_t>(sample.triangles.size());
  return header;
}

}  // namespace

ClusterSample::ClusterSample(const SequenceMesh& mesh, const EncoderSettings& settings,
                             const SpanFrames& frames)
    : num_vertices_(frames.num_vertices),
      sample_(sample_mesh(
          frames, mesh.triangles,
          sample_size(num_vertices_, std::min(kPositions / frames.num_frames, kMaxVertices)))),
      frames_(sample_.frames_of(frames, {0, frames.num_frames})),
      header_(header_of(mesh.header, sample_)),
      topology_(make_topology(frames_.num_vertices, sample_.triangles)),
      mesh_{header_, topology_, sample_.triangles},
      coding_(mesh_, settings, frames_) {}

ClusterSample::Estimate ClusterSample::cheapest(double step, const SpanCost& rival) const {
  // tuned (off: 100): Other numbers of clusters are not tried where the first costs more than
  // the rival by this factor. Of nine sequences at two errors, none costs less than the first
  // by more than a factor of 1.75.
  constexpr double kHopeless = 2.5;
  const auto maker = coding_.cluster_maker();
  const std::size_t last = last_cluster_count(frames_.num_vertices, kSampleCounts);
  const double scale = static_cast<double>(num_vertices_) / frames_.num_vertices;
  std::optional<Estimate> best;
  const auto cost_at = [&](std::size_t i, bool world) {
    const ClusterChoice choice{count_at(i), world};
    SpanCost cost = cost_of(coding_.encode(step, choice, *maker), frames_);
    cost.bits *= scale;
    cost.squared_error *= scale;
    if (!best || ratio_at_equal_error(cost, best->cost) < 1.0) best = {choice, cost};
    return cost;
  };
  for (const bool world : {false, true}) {
    const std::size_t start = std::min(world ? 0 : kFirstLocal, last);
    const SpanCost first = cost_at(start, world);
    if (ratio_at_equal_error(first, rival) > kHopeless) continue;
    climb(start, last, 1, [&](std::size_t i) {
      const SpanCost cost = i == start ? first : cost_at(i, world);
      return bits_at_equal_error(cost.bits, cost.squared_error);
    });
  }
  best->choice.clusters =
      std::clamp(static_cast<std::uint32_t>(std::lround(scale * best->choice.clusters)), 1U,
                 header_.level().max_clusters);
  return *best;
}

}  // namespace rlpc
