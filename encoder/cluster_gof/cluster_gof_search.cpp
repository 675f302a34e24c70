#include "encoder/cluster_gof/cluster_gof_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include "common/int_math.h"
#include "encoder/math/det_math.h"
#include "encoder/write/write_cluster_gof.h"

namespace rlpc {
namespace {

// Numbers of clusters worth comparing; finer ones gain little.
constexpr std::array<std::uint32_t, 13> kCounts{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96};
constexpr std::uint32_t kVerticesPerCluster = 8;  // fewer are not worth a frame of their own

// Seeds are coded this much finer than other values: their error turns whole clusters.
constexpr double kSeedStepFactor = 0.18;
// A component with less energy than this many squared steps costs more than it brings.
constexpr double kMinEnergySteps = 1.2;

EncodedGof encoded_gof(const ClusterContext& context, const ClusterGof& gof) {
  EncodedGof encoded;
  encoded.units.push_back(
      {UnitType::kGof, write_cluster_gof(gof, context.header, context.topology)});
  const auto recon = std::make_shared<ClusterRecon>(context.header, context.topology, gof);
  encoded.frame = [recon](std::uint32_t f, std::span<std::int32_t> positions) {
    recon->frame(f, positions);
  };
  encoded.num_factors = 3 * std::uint64_t{gof.seed_tracks.size()} * gof.num_frames;
  encoded.clusters = static_cast<std::uint32_t>(gof.clusters.size());
  for (const Cluster& cluster : gof.clusters) {
    const auto components = static_cast<std::uint32_t>(cluster.components.size());
    encoded.components += components;
    encoded.most_components = std::max(encoded.most_components, components);
    for (const Component& component : cluster.components) {
      encoded.num_factors += component.spatial_residual.size() + gof.num_frames;
    }
  }
  return encoded;
}

}  // namespace

ClusterGofSearch::ClusterGofSearch(const ClusterContext& context, const GofFrames& frames,
                                   std::uint32_t first_frame, const EncoderSettings& settings,
                                   std::optional<ClusterChoice>& choice)
    : context_(context),
      frames_(frames),
      first_frame_(first_frame),
      settings_(settings),
      tools_(settings.baseline),
      choice_(choice) {
  const bool world = tools_.frame_mode == FrameMode::kWorld;
  if (!choice_ && tools_.clusters > 0 && tools_.frame_mode != FrameMode::kAuto) {
    choice_ = ClusterChoice{tools_.clusters, world};
  }
}

ClusterAnalysisSettings ClusterGofSearch::analysis_settings(double step,
                                                            const ClusterChoice& choice) const {
  ClusterAnalysisSettings a;
  a.world = choice.world;
  a.max_components = kLevels.back().max_components;
  const double seed_step =
      tools_.qdelta > 0 ? exact_exp2(std::max(context_.header.position_bits - tools_.qdelta, 0))
                        : step * kSeedStepFactor;
  a.seed_step = static_cast<std::uint32_t>(
      std::clamp(std::floor(seed_step), 1.0, static_cast<double>(kMaxSeedStep)));
  if (settings_.components > 0) {
    // With a budget, clusters share: some take more than their mean.
    a.max_components = std::min<std::size_t>(
        a.max_components,
        tools_.rdo ? 4 * std::size_t{settings_.components} : settings_.components);
  } else if (tools_.qu == 0) {
    a.min_energy = kMinEnergySteps * step * step;
  }
  return a;
}

ClusterCodingSettings ClusterGofSearch::coding_settings(double step) const {
  ClusterCodingSettings c;
  c.step = step;
  c.components = settings_.components;
  if (tools_.qu > 0) {
    c.steps = ClusterCodingSettings::Steps::kRanges;
    c.qu = tools_.qu;
    c.qc = tools_.qc;
    c.dead_zone = 0.0;
  }
  if (!tools_.rdo) {
    c.allocation = ClusterCodingSettings::Allocation::kFixed;
  } else if (settings_.components > 0) {
    c.allocation = tools_.rate_in_vectors ? ClusterCodingSettings::Allocation::kVectorBudget
                                          : ClusterCodingSettings::Allocation::kBitBudget;
  }
  return c;
}

Clustering ClusterGofSearch::cluster(const ClusterChoice& choice) {
  if (!motion_) motion_.emplace(frames_, context_.triangles, context_.header.position_bits);
  const bool spread = tools_.seed_mode == SeedMode::kSpread ||
                      (tools_.seed_mode == SeedMode::kAuto && tools_.qu == 0);
  return spread ? motion_->spread_clusters(choice.clusters)
                : motion_->clusters(choice.clusters);
}

ClusterGofAnalysis ClusterGofSearch::analysis_for(double step, const ClusterChoice& choice,
                                                  const Clustering& clustering) const {
  return analyse_cluster_gof(context_, frames_, first_frame_, clustering,
                             analysis_settings(step, choice));
}

double ClusterGofSearch::cost(double step, const ClusterChoice& choice) {
  const EncodedGof encoded = encoded_gof(
      context_, code_cluster_gof(frames_, analysis_for(step, choice, cluster(choice)),
                                 coding_settings(step)));
  const double error = squared_error(frames_, encoded.frame);
  const double bits = 8.0 * static_cast<double>(encoded.units[0].payload.size());
  return error + coding_settings(step).lambda_factor * step * step * bits;
}

// Climbs from a middling number of clusters while the cost falls.
std::uint32_t ClusterGofSearch::choose_count(double step, bool world) {
  std::size_t last = 0;
  while (last + 1 < kCounts.size() &&
         kCounts[last + 1] * kVerticesPerCluster <= frames_.num_vertices) {
    ++last;
  }
  std::array<double, kCounts.size()> known{};
  const auto cost_at = [&](std::size_t i) {
    if (known[i] == 0.0) known[i] = cost(step, {kCounts[i], world});
    return known[i];
  };
  std::size_t best = std::min<std::size_t>(last, world ? 0 : 5);
  const std::size_t stride = settings_.preset == Preset::kSlow ? 1 : 2;
  for (const bool up : {true, false}) {
    for (std::size_t i = best; up ? i + stride <= last : i >= stride;) {
      i = up ? i + stride : i - stride;
      if (cost_at(i) >= cost_at(best)) break;
      best = i;
    }
  }
  return kCounts[best];
}

ClusterChoice ClusterGofSearch::choose(double step) {
  const bool fast = settings_.preset == Preset::kFast;
  if (fast) {
    const auto wanted = static_cast<std::uint32_t>(std::sqrt(frames_.num_vertices) / 3.0);
    return {tools_.clusters > 0 ? tools_.clusters : std::clamp(wanted, 1U, 32U),
            tools_.frame_mode == FrameMode::kWorld};
  }
  const auto best_of = [&](bool world) {
    return ClusterChoice{tools_.clusters > 0 ? tools_.clusters : choose_count(step, world),
                         world};
  };
  if (tools_.frame_mode != FrameMode::kAuto) {
    return best_of(tools_.frame_mode == FrameMode::kWorld);
  }
  const ClusterChoice local = best_of(false);
  const ClusterChoice world = best_of(true);
  return cost(step, world) < cost(step, local) ? world : local;
}

EncodedGof ClusterGofSearch::encode(double step, double analysis_step) {
  if (!choice_) choice_ = choose(step);
  if (!clustering_) clustering_ = cluster(*choice_);
  motion_.reset();
  if (!cached_ || cached_->step != analysis_step) {
    cached_.reset();  // before there is another
    cached_ = Cached{analysis_step, analysis_for(analysis_step, *choice_, *clustering_)};
  }
  return encoded_gof(context_,
                     code_cluster_gof(frames_, cached_->analysis, coding_settings(step)));
}

EncodedGof ClusterGofSearch::encode_once(double step, const ClusterChoice& choice) {
  const Clustering clustering = cluster(choice);
  motion_.reset();
  const ClusterGof gof =
      code_cluster_gof(frames_, analysis_for(step, choice, clustering), coding_settings(step));
  return encoded_gof(context_, gof);
}

}  // namespace rlpc
