#include "common/skinned_gof/recon/skinned_recon.h"

#include <algorithm>
#include <utility>

#include "common/components/series_predictor.h"
#include "common/int_math.h"

namespace rlpc {
namespace {

constexpr int kTemporalWeightFractionBits = 6;

}  // namespace

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

namespace {

// 8.14.2 Trajectories, and 8.5.2 for each coordinate: the temporal factor, [3 * num_frames].
TemporalFactor temporal_factor(const Trajectory& trajectory) {
  if (!trajectory.trajectory_flag) return {};
  TemporalFactor factor{{}, trajectory.temporal_bits};
  factor.values.reserve(3 * trajectory.residual.size());
  for (const Vec3i& value : recon_trajectory(trajectory)) {
    for (const std::int32_t x : value) {
      factor.values.push_back(
          scale_temporal(x, trajectory.scale_idx, trajectory.temporal_bits));
    }
  }
  return factor;
}

}  // namespace

// 8.14.3 Positions
SkinnedRecon::SkinnedRecon(const CodedMesh& mesh, const SkinnedGof& gof, int position_bits,
                           const Kernels& loops)
    : SkinnedRecon(std::make_shared<ModelRecon>(mesh, gof, position_bits, false), gof, loops) {}

SkinnedRecon::SkinnedRecon(std::shared_ptr<const ModelRecon> model, const SkinnedGof& gof,
                           const Kernels& loops)
    : num_frames_(gof.num_frames),
      widths_{gof.weight_bits, gof.fraction_bits, model->position_bits()},
      loops_(loops),
      model_(std::move(model)),
      bones_(recon_bones(gof.bones, gof.num_frames)) {
  std::vector<TemporalFactor> temporal;
  for (const Trajectory& t : gof.trajectories) temporal.push_back(temporal_factor(t));
  const auto add_sum = [&](std::shared_ptr<const SpatialFactors> spatial,
                           std::span<const TemporalFactor> of_spatial) {
    sums_.emplace_back(std::move(spatial), of_spatial, 3 * std::size_t{num_frames_}, loops);
  };
  const std::size_t shared = std::min(temporal.size(), model_->factors()->num_components());
  add_sum(model_->factors(), std::span(temporal).first(shared));
  if (gof.model && temporal.size() > shared) {
    add_sum(model_->local_factors(gof), std::span(temporal).subspan(shared));
  }
}

// Adds the rest positions of a tile as moved by their bones, times the weights.
void SkinnedRecon::skin_tile(std::size_t tile, std::uint32_t f, Sums& sums) const {
  // All vertices follow a single bone: the run holds their positions.
  const std::size_t num_runs = model_->num_runs(tile);
  const std::size_t n = std::min(kTileValues, model_->num_vertices() - tile * kTileValues);
  const bool alone = num_runs == 1 && model_->run(tile, 0).arms.size == n;
  if (!alone) {
    for (auto& of_coordinate : sums) of_coordinate.fill(0);
  }
  std::array<std::int64_t, kTileValues> places{};
  for (std::size_t i = 0; i < num_runs; ++i) {
    const ModelRecon::Run run = model_->run(tile, i);
    const BonePose& pose = bones_[run.bone].poses[f];
    for (std::size_t c = 0; c < 3; ++c) {
      Vec3i axis{};
      for (std::size_t k = 0; k < 3; ++k) axis[k] = static_cast<std::int32_t>(pose.axes[k][c]);
      const auto origin = static_cast<std::int32_t>(pose.origin[c]);
      loops_.weighted_places(run.arms, axis, origin, alone ? sums[c].data() : places.data());
      if (alone) continue;
      for (std::size_t k = 0; k < run.arms.size; ++k) sums[c][run.place[k]] += places[k];
    }
  }
}

void SkinnedRecon::frames(std::uint32_t first, std::uint32_t count,
                          std::span<std::int32_t> positions) const {
  Sums places{};
  std::array<std::array<std::int32_t, kTileValues>, 3> moved{};
  std::vector<std::int64_t> displacements(3 * std::size_t{count} * kTileValues);
  const std::size_t num_vertices = model_->num_vertices();
  for (std::size_t tile = 0; tile < model_->num_tiles(); ++tile) {
    std::fill(displacements.begin(), displacements.end(), 0);
    for (const ComponentSum& sum : sums_) {
      sum.add_tile(tile, 3 * std::size_t{first}, 3 * std::size_t{count}, displacements);
    }
    const std::size_t first_vertex = tile * kTileValues;
    const std::size_t n = std::min(kTileValues, num_vertices - first_vertex);
    for (std::uint32_t f = 0; f < count; ++f) {
      skin_tile(tile, first + f, places);
      for (std::size_t c = 0; c < 3; ++c) {
        loops_.positions(places[c].data(),
                         &displacements[(3 * std::size_t{f} + c) * kTileValues], widths_,
                         moved[c].data());
      }
      std::int32_t* const out = &positions[3 * (std::size_t{f} * num_vertices + first_vertex)];
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t c = 0; c < 3; ++c) out[3 * i + c] = moved[c][i];
      }
    }
  }
}

}  // namespace rlpc
