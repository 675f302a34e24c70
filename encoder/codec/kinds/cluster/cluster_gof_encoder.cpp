#include "encoder/codec/kinds/cluster/cluster_gof_encoder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/cluster/local_motion.h"
#include "encoder/codec/kinds/cluster/rate_allocation.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/symmetric_system.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// Codes the seed tracks in closed loop with the predictor of the GOF: residuals refer to
// recovered positions (delta coding, 3.3 of the paper).
void code_seed_tracks(ClusterGof& gof, const SpanFrames& frames, int position_bits) {
  std::vector<Track> tracks(gof.seed_tracks.size(), Track(gof.num_frames));
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    SeedTrack& track = gof.seed_tracks[i];
    track.residual.resize(gof.num_frames);
    for (std::uint32_t f = 0; f < gof.num_frames; ++f) {
      const Vec3i target = nearest_position(frames.at(f, track.vertex), position_bits);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::int64_t prediction = predict_seed(gof, tracks, i, f, c);
        const std::int64_t residual = div_round(target[c] - prediction, gof.seed_step);
        track.residual[f][c] = static_cast<std::int32_t>(residual);
        tracks[i][f][c] = clip_signed(position_bits, prediction + residual * gof.seed_step);
      }
    }
  }
}

double seed_bits(const ClusterGof& gof) {
  std::vector<std::int32_t> all;
  for (const SeedTrack& track : gof.seed_tracks) {
    for (const Vec3i& r : track.residual) all.insert(all.end(), r.begin(), r.end());
  }
  return estimate_bits(all);
}

void choose_seed_predictor(ClusterGof& gof, const SpanFrames& frames, int position_bits) {
  ClusterGof best = gof;
  double min = std::numeric_limits<double>::infinity();
  for (int order = 1; order <= kMaxPredictorOrder; ++order) {
    for (const bool coupling : {false, true}) {
      gof.seed_predictor = order;
      gof.seed_coupling_flag = coupling;
      code_seed_tracks(gof, frames, position_bits);
      const double bits = seed_bits(gof);
      if (bits >= min) continue;
      min = bits;
      best = gof;
    }
  }
  gof = std::move(best);
}

// Sets clusters and seed tracks, in the order of clause 6.5.2.
void set_clusters(ClusterGof& gof, const Clustering& clustering) {
  gof.cluster_of_vertex = clustering.cluster_of_vertex;
  gof.clusters.resize(clustering.num_clusters());
  for (std::size_t i = 0; i < clustering.seeds.size(); ++i) {
    gof.clusters[i].lcf_flag = true;
    gof.clusters[i].seed_vertex = clustering.seeds[i];
    std::uint32_t anchor = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = clustering.seeds[i][k];
      const auto known = std::find_if(gof.seed_tracks.begin(), gof.seed_tracks.end(),
                                      [&](const SeedTrack& t) { return t.vertex == v; });
      if (k == 0) anchor = static_cast<std::uint32_t>(known - gof.seed_tracks.begin());
      if (known != gof.seed_tracks.end()) continue;
      gof.seed_tracks.push_back({v, anchor, {}});
      gof.cluster_of_vertex[v] = kSeedCluster;
    }
  }
}

TrajectoryMatrix local_trajectories(const SpanFrames& frames, const ClusterAnalysis& cluster) {
  const std::size_t n = cluster.vertices.size();
  TrajectoryMatrix m{3 * n, frames.num_frames, std::vector<double>(3 * n * frames.num_frames)};
  for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
    std::optional<LocalFrame> local;
    if (!cluster.lcf.empty()) local.emplace(cluster.lcf[f]);
    for (std::size_t i = 0; i < n; ++i) {
      const double* p = frames.at(f, cluster.vertices[i]);
      std::array<double, 3> q{p[0], p[1], p[2]};
      if (local) q = local->to_local(p);
      for (std::size_t c = 0; c < 3; ++c) m.row(c * n + i)[f] = q[c];
    }
  }
  return m;
}

std::vector<Lcf> recovered_frames(const ClusterGof& gof, const Cluster& cluster,
                                  const std::vector<Track>& tracks) {
  std::vector<Lcf> lcf;
  if (!cluster.lcf_flag) return lcf;
  std::array<const Track*, 3> seed{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t t = 0; t < tracks.size(); ++t) {
      if (gof.seed_tracks[t].vertex == cluster.seed_vertex[k]) seed[k] = &tracks[t];
    }
  }
  for (std::uint32_t f = 0; f < gof.num_frames; ++f) {
    lcf.push_back(make_lcf((*seed[0])[f], (*seed[1])[f], (*seed[2])[f]));
  }
  return lcf;
}

// Chooses the quantiser steps of each component of a cluster.
class StepRule {
 public:
  StepRule(const ClusterCodingSettings& settings, const PrincipalComponents& pc,
           std::size_t count)
      : settings_(settings) {
    if (settings.steps != ClusterCodingSettings::Steps::kRanges) return;
    double u_min = 0.0;
    double u_max = 0.0;
    double c_min = 0.0;
    double c_max = 0.0;
    for (std::size_t l = 0; l < std::min(count, pc.spatial.size()); ++l) {
      const double sigma = std::sqrt(pc.energy[l]);
      for (const double y : pc.spatial[l]) {
        u_min = std::min(u_min, y / sigma);
        u_max = std::max(u_max, y / sigma);
      }
      for (const double v : pc.temporal[l]) {
        c_min = std::min(c_min, v * sigma);
        c_max = std::max(c_max, v * sigma);
      }
    }
    u_step_ = (u_max - u_min) / exact_exp2(settings.qu);
    c_step_ = (c_max - c_min) / exact_exp2(settings.qc);
  }

  StepPair steps(double energy, const std::vector<double>& spatial,
                 const std::vector<double>& temporal) const {
    const double sigma = std::sqrt(energy);
    double s = settings_.step;
    double t = settings_.step / sigma;
    if (settings_.steps == ClusterCodingSettings::Steps::kRanges) {
      s = u_step_ * sigma;
      t = c_step_ / sigma;
    }
    // Values must fit their coded widths, with room for make_steps() to change the spatial
    // step.
    s = std::max(s, largest(spatial) / (1 << (kMaxSpatialBits - 2)));
    t = std::max(t, largest(temporal) / (1 << (kTemporalIndexBits - 2)));
    return make_steps(s, t);
  }

 private:
  static double largest(const std::vector<double>& values) {
    double m = 0.0;
    for (const double x : values) m = std::max(m, std::abs(x));
    return m;
  }

  const ClusterCodingSettings& settings_;
  double u_step_ = 0.0;
  double c_step_ = 0.0;
};

QuantisedComponent quantise_component(const ClusterAnalysis& cluster, std::size_t l,
                                      const StepRule& rule, double dead_zone) {
  const PrincipalComponents& pc = cluster.pc;
  QuantisedComponent q;
  q.steps = rule.steps(pc.energy[l], pc.spatial[l], pc.temporal[l]);
  q.spatial = quantise(pc.spatial[l], q.steps.spatial, dead_zone);
  q.temporal = quantise(pc.temporal[l], q.steps.temporal, dead_zone);
  choose_predictors(q, *cluster.prediction);
  return q;
}

// Returns the squared error of quantising a component, without that of dropping others.
double quantisation_error(const QuantisedComponent& q, double energy) {
  const double spatial =
      q.steps.spatial * q.steps.spatial * static_cast<double>(q.spatial.size());
  const double temporal =
      q.steps.temporal * q.steps.temporal * energy * static_cast<double>(q.temporal.size());
  return (spatial + temporal) / 12.0;
}

RdCurve rd_curve(const ClusterAnalysis& cluster,
                 const std::vector<QuantisedComponent>& components, bool rate_in_vectors) {
  RdCurve curve{{0.0, cluster.pc.total_energy}};
  for (std::size_t l = 0; l < components.size(); ++l) {
    const double energy = cluster.pc.energy[l];
    const double added = std::min(quantisation_error(components[l], energy), energy);
    RdPoint point = curve.back();
    point.rate += rate_in_vectors ? 1.0 : components[l].bits;
    point.distortion += added - energy;
    curve.push_back(point);
  }
  return curve;
}

// Replaces the temporal values by the least-squares fit to the quantised spatial values.
void refit_temporal(const SpanFrames& frames, const ClusterAnalysis& cluster,
                    std::vector<QuantisedComponent>& components, double dead_zone) {
  const std::size_t count = components.size();
  if (count == 0) return;
  const TrajectoryMatrix matrix = local_trajectories(frames, cluster);
  const std::size_t num_frames = matrix.num_frames;
  const std::size_t num_values = matrix.num_values;
  std::vector<double> s(num_values * count);  // [num_values][count]
  for (std::size_t l = 0; l < count; ++l) {
    for (std::size_t i = 0; i < num_values; ++i) {
      s[i * count + l] = components[l].spatial[i] * components[l].steps.spatial;
    }
  }
  std::vector<double> g(count * count, 0.0);
  std::vector<double> projected(count * num_frames, 0.0);
  for (std::size_t i = 0; i < num_values; ++i) {
    const double* a = matrix.row(i);
    const double* si = &s[i * count];
    for (std::size_t l = 0; l < count; ++l) {
      if (si[l] == 0.0) continue;
      double* p = &projected[l * num_frames];
      for (std::size_t f = 0; f < num_frames; ++f) p[f] += si[l] * a[f];
      for (std::size_t k = l; k < count; ++k) g[l * count + k] += si[l] * si[k];
    }
  }
  const SymmetricSystem gram(std::move(g), count);
  if (!gram.is_unique()) return;  // a spatial vector was quantised to zero: keep the projection
  gram.solve(projected, num_frames);
  for (std::size_t l = 0; l < count; ++l) {
    const auto row = projected.begin() + static_cast<std::ptrdiff_t>(l * num_frames);
    const std::vector<double> t(row, row + static_cast<std::ptrdiff_t>(num_frames));
    components[l].temporal = quantise(t, components[l].steps.temporal, dead_zone);
    choose_predictors(components[l], *cluster.prediction);
  }
}

}  // namespace

ClusterGofAnalysis analyse_cluster_gof(const SequenceMesh& mesh, const SpanFrames& frames,
                                       const Clustering& clustering,
                                       const ClusterAnalysisSettings& settings) {
  const int position_bits = mesh.header.position_bits;
  ClusterGofAnalysis analysis;
  ClusterGof& gof = analysis.gof;
  gof.first_frame = frames.first_frame;
  gof.num_frames = frames.num_frames;
  gof.seed_step = settings.seed_step;
  if (settings.world) {
    gof.clusters.resize(clustering.num_clusters());
    gof.cluster_of_vertex = clustering.cluster_of_vertex;
  } else {
    set_clusters(gof, clustering);
    choose_seed_predictor(gof, frames, position_bits);
  }
  const std::vector<Track> tracks = recon_seed_tracks(gof, position_bits);
  const ClusterMembers members = cluster_members(gof);
  analysis.clusters.resize(gof.clusters.size());
  for_each(gof.clusters.size(), [&](std::size_t i) {
    ClusterAnalysis& cluster = analysis.clusters[i];
    cluster.prediction.emplace(mesh.topology, members.vertices[i], gof.cluster_of_vertex,
                               members.local_index);
    cluster.vertices = members.vertices[i];
    cluster.lcf = recovered_frames(gof, gof.clusters[i], tracks);
    cluster.pc = principal_components(local_trajectories(frames, cluster),
                                      settings.max_components, settings.min_energy);
  });
  return analysis;
}

ClusterGof code_cluster_gof(const SpanFrames& frames, const ClusterGofAnalysis& analysis,
                            const ClusterCodingSettings& settings) {
  using Allocation = ClusterCodingSettings::Allocation;
  const std::size_t count = analysis.clusters.size();
  std::vector<std::vector<QuantisedComponent>> components(count);
  std::vector<RdCurve> curves(count);
  std::vector<double> rates(count);
  for_each(count, [&](std::size_t i) {
    const ClusterAnalysis& cluster = analysis.clusters[i];
    std::size_t candidates = cluster.pc.spatial.size();
    if (settings.allocation == Allocation::kFixed) {
      candidates = std::min<std::size_t>(candidates, settings.components);
    }
    const StepRule rule(settings, cluster.pc,
                        settings.components > 0 ? settings.components : candidates);
    for (std::size_t l = 0; l < candidates; ++l) {
      components[i].push_back(quantise_component(cluster, l, rule, settings.dead_zone));
    }
    curves[i] =
        rd_curve(cluster, components[i], settings.allocation == Allocation::kVectorBudget);
    rates[i] = curves[i][std::min<std::size_t>(settings.components, candidates)].rate;
  });
  std::vector<std::size_t> chosen(count);
  if (settings.allocation == Allocation::kSlope) {
    const double lambda = rlpc::lambda(settings.step);
    for (std::size_t i = 0; i < count; ++i) chosen[i] = allocate_by_slope(curves[i], lambda);
  } else if (settings.allocation == Allocation::kFixed) {
    for (std::size_t i = 0; i < count; ++i) chosen[i] = components[i].size();
  } else {
    chosen = allocate_within(curves, std::accumulate(rates.begin(), rates.end(), 0.0));
  }
  for_each(count, [&](std::size_t i) {
    components[i].resize(chosen[i]);
    refit_temporal(frames, analysis.clusters[i], components[i], settings.dead_zone);
  });
  ClusterGof gof = analysis.gof;
  gof.fraction_bits = choose_fraction_bits(components);
  for (std::size_t i = 0; i < count; ++i) {
    for (const QuantisedComponent& c : components[i]) {
      gof.clusters[i].components.push_back(
          make_component(c, *analysis.clusters[i].prediction, gof.fraction_bits));
    }
  }
  return gof;
}

}  // namespace rlpc
