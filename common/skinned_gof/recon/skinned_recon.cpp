#include "common/skinned_gof/recon/skinned_recon.h"

#include <algorithm>
#include <utility>

#include "common/components/series_predictor.h"
#include "common/int_math.h"
#include "common/skinned_gof/influences.h"

namespace rlpc {
namespace {

constexpr int kTemporalWeightFractionBits = 6;

// 8.10.2 Spatial values, vertex by vertex.
class GroupRecon {
 public:
  GroupRecon(const CodedMesh& mesh, const SkinnedGof& gof, std::size_t group, int position_bits,
             const ValuePrediction& prediction, AdaptiveWeights* weights)
      : mesh_(mesh),
        gof_(gof),
        group_(group),
        prediction_(prediction),
        weights_(weights),
        bits_(factor_group(gof, group).size(), rest_bits(position_bits)),
        values_(gof.vertex_residual[group].size()) {
    const FactorGroup factors = factor_group(gof, group);
    for (std::size_t k = 0; k < bits_.size() && group > 0; ++k) {
      bits_[k] = gof.trajectories[factors.first + k - kRestFactors].spatial_bits;
    }
    if (weights != nullptr) weights->start(factors.first - kRestFactors, factors.size());
  }

  // Vertices that precede these in the order must be done, unless they are in the same layer
  // and that is not the base.
  void decode(std::span<const std::uint32_t> vertices) {
    std::vector<std::int64_t> predicted(bits_.size());
    std::optional<VertexAdaptation> adaptation;
    if (weights_ != nullptr) adaptation.emplace(*weights_);
    for (const std::uint32_t v : vertices) {
      if (adaptation && adaptation->start(v, values_)) {
        decode(v, *adaptation);
      } else {
        decode(v, predicted);
      }
    }
  }
  std::vector<std::int32_t> take_values() { return std::move(values_); }

 private:
  void decode(std::uint32_t v, VertexAdaptation& adaptation) {
    const std::size_t n = bits_.size();
    const int layer_step = gof_.layer_step[mesh_.layer_of(v)];
    for (std::size_t k = 0; k < n; ++k) {
      const std::int64_t predicted = adaptation.predict();
      const std::int32_t residual = gof_.vertex_residual[group_][v * n + k];
      values_[v * n + k] =
          clip_signed(bits_[k], predicted + factor_difference(residual, layer_step));
      adaptation.add(predicted, values_[v * n + k]);
    }
    adaptation.finish();
  }

  void decode(std::uint32_t v, std::span<std::int64_t> predicted) {
    const std::size_t n = bits_.size();
    const int layer_step = gof_.layer_step[mesh_.layer_of(v)];
    prediction_.predict(v, values_, predicted);
    for (std::size_t k = 0; k < n; ++k) {
      const std::int32_t residual = gof_.vertex_residual[group_][v * n + k];
      const std::int64_t difference = group_ == 0 ? rest_difference(gof_, residual, layer_step)
                                                  : factor_difference(residual, layer_step);
      values_[v * n + k] = clip_signed(bits_[k], predicted[k] + difference);
    }
  }

  const CodedMesh& mesh_;
  const SkinnedGof& gof_;
  std::size_t group_;
  const ValuePrediction& prediction_;
  AdaptiveWeights* weights_;
  std::vector<int> bits_;             // [factor]
  std::vector<std::int32_t> values_;  // [num_vertices][factor]
};

}  // namespace

std::vector<std::int32_t> recon_values(const CodedMesh& mesh, const SkinnedGof& gof,
                                       std::size_t group, int position_bits,
                                       const ValuePrediction& prediction,
                                       AdaptiveWeights* weights, const ForEach& for_each) {
  GroupRecon recon(mesh, gof, group, position_bits, prediction, weights);
  if (weights == nullptr) {
    recon.decode(mesh.order());
    return recon.take_values();
  }
  constexpr std::size_t kTogether = 64;  // vertices to a pass of the loop
  recon.decode(mesh.vertices_of_layers(0, 1));
  for (std::uint32_t layer = 1; layer < mesh.num_layers(); ++layer) {
    const auto vertices = mesh.vertices_of_layers(layer, layer + 1);
    for_each((vertices.size() + kTogether - 1) / kTogether, [&](std::size_t i) {
      const std::size_t first = i * kTogether;
      recon.decode(vertices.subspan(first, std::min(kTogether, vertices.size() - first)));
    });
  }
  return recon.take_values();
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
Vec3l predict_trajectory(const Trajectory& trajectory, std::span<const Vec3i> values) {
  Vec3l prediction{};
  const auto f = static_cast<std::uint32_t>(values.size());
  int order = trajectory.temporal_predictor;
  if (order > kMaxPredictorOrder) {
    const auto count = static_cast<std::size_t>(order - kMaxPredictorOrder);
    if (f >= count) {
      for (std::size_t c = 0; c < 3; ++c) {
        std::int64_t sum = 0;
        for (std::size_t k = 0; k < count; ++k) {
          sum += std::int64_t{trajectory.temporal_weight[k]} * values[f - 1 - k][c];
        }
        prediction[c] = round2(sum, kTemporalWeightFractionBits);
      }
      return prediction;
    }
    order = 1;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    prediction[c] =
        predict_series([&](std::uint32_t g) { return std::int64_t{values[g][c]}; }, f, order);
  }
  return prediction;
}

std::vector<Vec3i> recon_trajectory(const Trajectory& trajectory) {
  std::vector<Vec3i> values;
  values.reserve(trajectory.residual.size());
  for (const Vec3i& residual : trajectory.residual) {
    const Vec3l prediction = predict_trajectory(trajectory, values);
    Vec3i value{};
    for (std::size_t c = 0; c < 3; ++c) {
      value[c] = clip_signed(kTemporalIndexBits, prediction[c] + residual[c]);
    }
    values.push_back(value);
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
                           const ForEach& for_each, const Kernels& loops)
    : num_frames_(gof.num_frames),
      num_vertices_(mesh.num_vertices()),
      widths_{gof.weight_bits, gof.fraction_bits, position_bits},
      loops_(loops),
      bones_(recon_bones(gof.bones, gof.num_frames)),
      factors_(mesh.num_vertices(), 3 * std::size_t{gof.num_frames}, loops) {
  const auto rest = recon_values(mesh, gof, 0, position_bits, {mesh, true, nullptr});
  add_influences(complete_influences(mesh, gof), rest);
  add_factors(mesh, gof, rest, for_each);
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
                               std::span<const std::int32_t> rest, const ForEach& for_each) {
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
                                     adaptive ? &*adaptive : nullptr, for_each);
    for (std::size_t k = 0; k < factors.size(); ++k) {
      const Trajectory& trajectory = gof.trajectories[factors.first + k - kRestFactors];
      const std::vector<Vec3i> series = recon_trajectory(trajectory);
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
