#include "common/codec/kinds/skinned/recon/skinned_recon.h"

#include <algorithm>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/memory/owned.h"

namespace rlpc {

// 8.14.2 Trajectories
Vector<Vec3i> recon_trajectory(const Trajectory& trajectory, int track_levels) {
  const auto num_frames = static_cast<std::uint32_t>(trajectory.residual.size());
  Vector<Vec3i> values(num_frames);
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

namespace {

// 8.14.2 Trajectories, and 8.5.2 for each coordinate: the temporal factor, [3 * num_frames].
TemporalFactor temporal_factor(const Trajectory& trajectory, int track_levels) {
  if (!trajectory.trajectory_flag) return {};
  TemporalFactor factor{{}, trajectory.temporal_bits};
  factor.values.reserve(3 * trajectory.residual.size());
  for (const Vec3i& value : recon_trajectory(trajectory, track_levels)) {
    for (const std::int32_t x : value) {
      factor.values.push_back(
          scale_temporal(x, trajectory.scale_idx, trajectory.temporal_bits));
    }
  }
  return factor;
}

}  // namespace

// 8.14.3 Positions
SkinnedRecon::SkinnedRecon(const OrderedMesh& mesh, const SkinnedGof& gof, int position_bits,
                           const Kernels& loops)
    : SkinnedRecon(make_shared_owned<RigRecon>(mesh, gof, position_bits, false), gof, loops) {}

SkinnedRecon::SkinnedRecon(std::shared_ptr<const RigRecon> rig, const SkinnedGof& gof,
                           const Kernels& loops)
    : num_frames_(gof.num_frames),
      rest_step_(gof.rig ? gof.rig->rest_step : gof.rest_step),
      widths_{gof.weight_bits, gof.fraction_bits, rig->position_bits()},
      loops_(loops),
      rig_(std::move(rig)),
      bones_(recon_bones(gof.bones, gof.num_frames, gof.track_levels)) {
  for (const Bone& bone : gof.bones) {
    values_of_frame_ += 3 * (std::size_t{bone.rotation_flag} + std::size_t{bone.origin_flag} +
                             std::size_t{bone.stretch != Stretch::kNone});
  }
  values_of_frame_ += 3 * gof.trajectories.size();
  Vector<TemporalFactor> temporal;
  for (const Trajectory& t : gof.trajectories) {
    temporal.push_back(temporal_factor(t, gof.track_levels));
  }
  const auto add_sum = [&](std::shared_ptr<const SpatialFactors> spatial,
                           std::span<const TemporalFactor> temporal_factors) {
    sums_.emplace_back(std::move(spatial), temporal_factors, 3 * std::size_t{num_frames_},
                       loops);
  };
  const std::size_t shared = std::min(temporal.size(), rig_->factors()->num_components());
  add_sum(rig_->factors(), std::span(temporal).first(shared));
  if (gof.rig && temporal.size() > shared) {
    add_sum(rig_->local_factors(gof), std::span(temporal).subspan(shared));
  }
}

Skeleton SkinnedRecon::skeleton() const {
  Skeleton skeleton;
  skeleton.step = rest_step_;
  skeleton.values_of_vertex = kRestFactors + rig_->factors()->num_components();
  for (const BoneMotion& bone : bones_) {
    skeleton.bones.push_back({bone.parent, {bone.along, bone.pivot}});
  }
  skeleton.influences.resize(rig_->num_vertices());
  for (std::size_t tile = 0; tile < rig_->num_tiles(); ++tile) {
    for (std::size_t i = 0; i < rig_->num_runs(tile); ++i) {
      const RigRecon::Run run = rig_->run(tile, i);
      for (std::size_t k = 0; k < run.arms.size; ++k) {
        skeleton.influences[tile * kTileValues + run.place[k]].push_back(
            {static_cast<std::uint16_t>(run.bone),
             static_cast<std::uint16_t>(run.arms.weight[k])});
      }
    }
  }
  return skeleton;
}

Vector<BonePlace> SkinnedRecon::places(std::uint32_t f) const {
  Vector<BonePlace> places;
  for (const BoneMotion& bone : bones_) {
    const BonePose& pose = bone.poses[f];
    // The axes along which a bone stretches are its own; otherwise, those of the rest shape.
    places.push_back(
        {product_of_axes(pose.axes, bone.along, kQuaternionFractionBits), pose.origin});
  }
  return places;
}

// Adds the rest positions of a tile as moved by their bones, times the weights.
void SkinnedRecon::skin_tile(std::size_t tile, std::uint32_t f, Sums& sums) const {
  // If all vertices follow a single bone, the run holds their positions.
  const std::size_t num_runs = rig_->num_runs(tile);
  const std::size_t n = std::min(kTileValues, rig_->num_vertices() - tile * kTileValues);
  const bool alone = num_runs == 1 && rig_->run(tile, 0).arms.size == n;
  if (!alone) {
    for (auto& coordinate_sums : sums) coordinate_sums.fill(0);
  }
  std::array<std::int64_t, kTileValues> places{};
  for (std::size_t i = 0; i < num_runs; ++i) {
    const RigRecon::Run run = rig_->run(tile, i);
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
  Vector<std::int64_t> displacements(3 * std::size_t{count} * kTileValues);
  const std::size_t num_vertices = rig_->num_vertices();
  for (std::size_t tile = 0; tile < rig_->num_tiles(); ++tile) {
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
