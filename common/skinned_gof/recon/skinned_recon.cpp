#include "common/skinned_gof/recon/skinned_recon.h"

#include <algorithm>
#include <utility>

#include "common/int_math.h"
#include "common/skinned_gof/influences.h"

namespace rlpc {
// 8.10.2 Spatial values
std::vector<std::int32_t> recon_values(const CodedMesh& mesh, const SkinnedGof& gof,
                                       std::size_t group, int position_bits,
                                       const ValuePrediction& prediction,
                                       AdaptiveWeights* weights) {
  const FactorGroup factors = factor_group(gof, group);
  const std::size_t n = factors.size();
  const std::vector<std::int32_t>& residuals = gof.vertex_residual[group];
  std::vector<int> bits(n, rest_bits(position_bits));
  for (std::size_t k = 0; k < n && group > 0; ++k) {
    bits[k] = gof.trajectories[factors.first + k - kRestFactors].spatial_bits;
  }
  std::vector<std::int32_t> values(residuals.size());
  std::vector<std::int64_t> predicted(n);
  std::optional<VertexAdaptation> adaptation;
  if (weights != nullptr) {
    weights->start(factors.first - kRestFactors, n);
    adaptation.emplace(*weights);
  }
  for (const std::uint32_t v : mesh.order()) {
    const int layer_step = gof.layer_step[mesh.layer_of(v)];
    if (adaptation && adaptation->start(v, values)) {
      for (std::size_t k = 0; k < n; ++k) {
        const std::int64_t of_weights = adaptation->predict();
        values[v * n + k] = clip_signed(
            bits[k], of_weights + factor_difference(residuals[v * n + k], layer_step));
        adaptation->add(of_weights, values[v * n + k]);
      }
      adaptation->finish();
      continue;
    }
    prediction.predict(v, values, predicted);
    for (std::size_t k = 0; k < n; ++k) {
      const std::int32_t residual = residuals[v * n + k];
      const std::int64_t difference = group == 0 ? rest_difference(gof, residual, layer_step)
                                                 : factor_difference(residual, layer_step);
      values[v * n + k] = clip_signed(bits[k], predicted[k] + difference);
    }
  }
  return values;
}

std::vector<Influences> complete_influences(const CodedMesh& mesh, const SkinnedGof& gof) {
  std::vector<Influences> influences = gof.influences;
  InfluencePrediction prediction(influences, static_cast<std::uint32_t>(gof.bones.size()),
                                 gof.weight_bits);
  std::uint32_t first = 0;
  for (std::uint32_t j = 0; j < gof.slice_layers[0]; ++j) first += gof.layer_group_size[j];
  for (const std::uint32_t v : mesh.vertices_of_layers(first, mesh.num_layers())) {
    prediction.start(mesh.ring(v));
    for (std::size_t k = 1; k < prediction.num_candidates(); ++k)
      prediction.add_candidate(k, 0);
    influences[v] = prediction.finish();
  }
  return influences;
}

// 8.14.2 Trajectories
std::vector<Vec3i> recon_trajectory(const Trajectory& trajectory, int track_levels) {
  const auto num_frames = static_cast<std::uint32_t>(trajectory.residual.size());
  std::vector<Vec3i> values(num_frames);
  for (const TrackPlace& at :
       track_order(num_frames, track_levels, trajectory.temporal_between)) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto known = [&](std::uint32_t f) { return std::int64_t{values[f][c]}; };
      values[at.frame][c] =
          clip_signed(kTemporalIndexBits, predict_trajectory(trajectory, known, at) +
                                              trajectory.residual[at.frame][c]);
    }
  }
  return values;
}

Vec3l skinned_point(const Influences& influences, int weight_bits,
                    std::span<const BoneMotion> bones, std::uint32_t f, const Vec3l& point) {
  Vec3l sum{};
  for (const Influence& influence : influences) {
    const BoneMotion& bone = bones[influence.bone];
    const Vec3l moved = moved_point(bone.poses[f], bone.pivot, point);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += influence.weight * moved[c];
  }
  for (std::int64_t& x : sum) x = round2(x, weight_bits);
  return sum;
}

// 8.14.3 Positions
SkinnedRecon::SkinnedRecon(const CodedMesh& mesh, const SkinnedGof& gof, int position_bits,
                           const Kernels& loops)
    : num_frames_(gof.num_frames),
      num_vertices_(mesh.num_vertices()),
      widths_{gof.weight_bits, gof.fraction_bits, position_bits},
      loops_(loops),
      bones_(recon_bones(gof.bones, gof.num_frames, gof.track_levels)),
      factors_(mesh.num_vertices(), 3 * std::size_t{gof.num_frames}, loops) {
  const auto rest = recon_values(mesh, gof, 0, position_bits, {mesh, true, nullptr});
  add_influences(complete_influences(mesh, gof), rest);
  add_factors(mesh, gof, rest);
}

void SkinnedRecon::add_influences(std::span<const Influences> influences,
                                  std::span<const std::int32_t> rest) {
  struct Entry {
    Influence influence;
    std::size_t vertex;
  };
  std::vector<Entry> of_tile;
  for (std::size_t first = 0; first < num_vertices_; first += kTileValues) {
    of_tile.clear();
    for (std::size_t v = first; v < std::min(first + kTileValues, num_vertices_); ++v) {
      for (const Influence& influence : influences[v]) of_tile.push_back({influence, v});
    }
    std::stable_sort(of_tile.begin(), of_tile.end(), [](const Entry& a, const Entry& b) {
      return a.influence.bone < b.influence.bone;
    });
    first_run_.push_back(runs_.size());
    for (const auto& [influence, v] : of_tile) {
      const auto next = static_cast<std::uint32_t>(weight_.size());
      if (first_run_.back() == runs_.size() || runs_.back().bone != influence.bone) {
        runs_.push_back({influence.bone, next, next});
      }
      ++runs_.back().end;
      const Vec3l& pivot = bones_[influence.bone].pivot;
      for (std::size_t c = 0; c < 3; ++c) {
        arm_[c].push_back(static_cast<std::int32_t>(rest[3 * v + c] - pivot[c]));
      }
      weight_.push_back(influence.weight);
      place_.push_back(static_cast<std::uint8_t>(v - first));
    }
  }
  first_run_.push_back(runs_.size());
  // The kernels may read one vector past the end.
  for (auto& list : arm_) list.resize(list.size() + 3);
  weight_.resize(weight_.size() + 3);
}

void SkinnedRecon::add_factors(const CodedMesh& mesh, const SkinnedGof& gof,
                               std::span<const std::int32_t> rest) {
  std::array<std::vector<std::int32_t>, 3> plane;
  std::optional<GeometryWeights> weights;
  std::optional<AdaptiveWeights> adaptive;
  if (gof.prediction == Prediction::kLayers && !gof.trajectories.empty()) {
    for (std::size_t i = 0; i < rest.size(); ++i) plane[i % 3].push_back(rest[i]);
    const std::array<std::span<const std::int32_t>, 3> planes{plane[0], plane[1], plane[2]};
    weights.emplace(mesh, gof.weights, planes);
    if (gof.weights.num_adaptive_factors > 0) {
      adaptive.emplace(mesh, *weights, gof.weights, planes);
    }
  }
  const ValuePrediction prediction(mesh, false, weights ? &*weights : nullptr);
  std::vector<std::int32_t> temporal(3 * std::size_t{num_frames_});
  for (std::size_t group = 1; group < gof.group_end.size(); ++group) {
    const FactorGroup factors = factor_group(gof, group);
    const auto values = recon_values(mesh, gof, group, widths_.position_bits, prediction,
                                     adaptive ? &*adaptive : nullptr);
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const Trajectory& trajectory = gof.trajectories[factors.first + k - kRestFactors];
      const std::vector<Vec3i> series = recon_trajectory(trajectory, gof.track_levels);
      for (std::size_t f = 0; f < num_frames_; ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
          temporal[3 * f + c] =
              scale_temporal(series[f][c], trajectory.scale_idx, trajectory.temporal_bits);
        }
      }
      factors_.add(temporal, trajectory.temporal_bits, std::span(values).subspan(k),
                   trajectory.spatial_bits, factors.size());
    }
  }
}

// Adds the rest positions of a tile as moved by their bones, times the weights.
void SkinnedRecon::skin_tile(std::size_t tile, std::uint32_t f, Sums& sums) const {
  const auto runs =
      std::span(runs_).subspan(first_run_[tile], first_run_[tile + 1] - first_run_[tile]);
  // All vertices follow a single bone: the run holds their positions.
  const std::size_t n = std::min(kTileValues, num_vertices_ - tile * kTileValues);
  const bool alone = runs.size() == 1 && runs[0].end - runs[0].first == n;
  if (!alone) {
    for (auto& of_coordinate : sums) of_coordinate.fill(0);
  }
  std::array<std::int64_t, kTileValues> places{};
  for (const Run& run : runs) {
    const BonePose& pose = bones_[run.bone].poses[f];
    const BoneArms arms{{&arm_[0][run.first], &arm_[1][run.first], &arm_[2][run.first]},
                        &weight_[run.first],
                        run.end - run.first};
    for (std::size_t c = 0; c < 3; ++c) {
      Vec3i axis{};
      for (std::size_t k = 0; k < 3; ++k) axis[k] = static_cast<std::int32_t>(pose.axes[k][c]);
      const auto origin = static_cast<std::int32_t>(pose.origin[c]);
      loops_.weighted_places(arms, axis, origin, alone ? sums[c].data() : places.data());
      if (alone) continue;
      for (std::size_t i = 0; i < arms.size; ++i) sums[c][place_[run.first + i]] += places[i];
    }
  }
}

void SkinnedRecon::frames(std::uint32_t first, std::uint32_t count,
                          std::span<std::int32_t> positions) const {
  Sums places{};
  std::array<std::array<std::int32_t, kTileValues>, 3> moved{};
  std::vector<std::int64_t> displacements(3 * std::size_t{count} * kTileValues);
  for (std::size_t tile = 0; tile + 1 < first_run_.size(); ++tile) {
    factors_.sum_tile(tile, 3 * std::size_t{first}, 3 * std::size_t{count}, displacements);
    const std::size_t first_vertex = tile * kTileValues;
    const std::size_t n = std::min(kTileValues, num_vertices_ - first_vertex);
    for (std::uint32_t f = 0; f < count; ++f) {
      skin_tile(tile, first + f, places);
      for (std::size_t c = 0; c < 3; ++c) {
        loops_.positions(places[c].data(),
                         &displacements[(3 * std::size_t{f} + c) * kTileValues], widths_,
                         moved[c].data());
      }
      std::int32_t* const out = &positions[3 * (std::size_t{f} * num_vertices_ + first_vertex)];
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t c = 0; c < 3; ++c) out[3 * i + c] = moved[c][i];
      }
    }
  }
}

}  // namespace rlpc
