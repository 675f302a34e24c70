#include "encoder/codec/kinds/cluster/cluster_gof_coding.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <span>

#include "common/codec/bits/int_math.h"
#include "encoder/codec/kinds/cluster/partition_clusters.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/write/write_cluster_gof.h"

namespace rlpc {
namespace {

// tuned (off: 1): Quantiser step of seed tracks relative to that of components. An error of a
// seed turns its whole cluster, so seeds are coded finer.
constexpr double kSeedStep = 0.18;
// tuned (off: 0): Components of less energy than this many squared steps are not considered. It
// only saves time, as the allocation by rate and distortion leaves such components out.
constexpr double kMinEnergy = 1.2;
// tuned: With a given number of components per cluster, one cluster may take up to this
// multiple of it at the expense of others.
constexpr std::size_t kShare = 4;

// Returns the mean over all frames of the largest extent of a frame's bounding box.
double mean_extent(const SpanFrames& frames) {
  double sum = 0.0;
  for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
    double largest = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      double low = frames.at(f, 0)[c];
      double high = low;
      for (std::uint32_t v = 1; v < frames.num_vertices; ++v) {
        low = std::min(low, frames.at(f, v)[c]);
        high = std::max(high, frames.at(f, v)[c]);
      }
      largest = std::max(largest, high - low);
    }
    sum += largest;
  }
  return sum / frames.num_frames;
}

}  // namespace

std::unique_ptr<ClusterMaker> ClusterGofCoding::cluster_maker() const {
  const int position_bits = mesh_.header.position_bits;
  const PartitionMethod method = settings_.baseline.partition;
  if (method == PartitionMethod::kSeeds) {
    const SeedRules rules{settings_.baseline.seed_mode == SeedMode::kFirst,
                          settings_.baseline.motion == MotionMeasure::kPlain
                              ? DistanceSum::kPlain
                              : DistanceSum::kSquared};
    return std::make_unique<MotionClusters>(
        frames_, rules.first ? mesh_.input_triangles : mesh_.triangles, position_bits, rules);
  }
  return std::make_unique<PartitionClusters>(method, frames_, mesh_.triangles, position_bits);
}

Clustering ClusterGofCoding::cluster(ClusterMaker& maker, std::uint32_t count) const {
  const SeedMode mode = settings_.baseline.seed_mode;
  const bool spread =
      mode == SeedMode::kSpread || (mode == SeedMode::kAuto && settings_.baseline.qu == 0);
  return spread ? maker.spread_clusters(count) : maker.clusters(count);
}

ClusterAnalysisSettings ClusterGofCoding::analysis_settings(double step, bool world) const {
  const BaselineTools& tools = settings_.baseline;
  ClusterAnalysisSettings a;
  a.world = world;
  a.max_components = kLevels.back().max_components;
  const double seed_step =
      tools.qdelta > 0 ? mean_extent(frames_) / exact_exp2(tools.qdelta) : step * kSeedStep;
  a.seed_step = static_cast<std::uint32_t>(
      std::clamp(std::floor(seed_step), 1.0, static_cast<double>(kMaxSeedStep)));
  if (settings_.components > 0) {
    // The budget is shared by all clusters: some take more components than the mean.
    a.max_components = std::min<std::size_t>(
        a.max_components, tools.rdo ? kShare * settings_.components : settings_.components);
  } else if (tools.qu == 0) {
    a.min_energy = kMinEnergy * step * step;
  }
  return a;
}

ClusterCodingSettings ClusterGofCoding::coding_settings(double step) const {
  const BaselineTools& tools = settings_.baseline;
  ClusterCodingSettings c;
  c.step = step;
  c.components = settings_.components;
  if (tools.qu > 0) {
    c.steps = ClusterCodingSettings::Steps::kRanges;
    c.qu = tools.qu;
    c.qc = tools.qc;
    c.dead_zone = 0.0;
  }
  if (!tools.rdo) {
    c.allocation = ClusterCodingSettings::Allocation::kFixed;
  } else if (settings_.components > 0) {
    c.allocation = tools.rate_in_vectors ? ClusterCodingSettings::Allocation::kVectorBudget
                                         : ClusterCodingSettings::Allocation::kBitBudget;
  }
  return c;
}

ClusterGofAnalysis ClusterGofCoding::analyse(double step, bool world,
                                             const Clustering& clustering) const {
  return analyse_cluster_gof(mesh_, frames_, clustering, analysis_settings(step, world));
}

EncodedSpan ClusterGofCoding::encode(double step, const ClusterGofAnalysis& analysis) const {
  const ClusterGof gof = code_cluster_gof(frames_, analysis, coding_settings(step));
  EncodedSpan encoded;
  encoded.units.push_back(
      {UnitType::kGof, write_cluster_gof(gof, mesh_.header, mesh_.topology)});
  const auto recon = std::make_shared<ClusterRecon>(mesh_.header, mesh_.topology, gof);
  encoded.frame = [recon](std::uint32_t f, std::span<std::int32_t> positions) {
    recon->frame(f, positions);
  };
  encoded.num_factors = 3 * std::uint64_t{gof.seed_tracks.size()} * gof.num_frames;
  encoded.clusters = static_cast<std::uint32_t>(gof.clusters.size());
  encoded.max_clusters = encoded.clusters;
  for (const Cluster& cluster : gof.clusters) {
    const auto components = static_cast<std::uint32_t>(cluster.components.size());
    encoded.components += components;
    encoded.max_components = std::max(encoded.max_components, components);
    for (const Component& component : cluster.components) {
      encoded.num_factors += component.spatial_residual.size() + gof.num_frames;
    }
  }
  return encoded;
}

EncodedSpan ClusterGofCoding::encode(double step, const ClusterChoice& choice,
                                     ClusterMaker& maker) const {
  return encode(step, analyse(step, choice.world, cluster(maker, choice.clusters)));
}

}  // namespace rlpc
