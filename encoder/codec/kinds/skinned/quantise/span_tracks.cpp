#include "encoder/codec/kinds/skinned/quantise/span_tracks.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/codec/kernels/component_sum.h"
#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "encoder/codec/kinds/skinned/tracks/track_coding.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {

double power_of_eighths(int eighths) {
  constexpr double kMantissaUnit = 32768.0;  // fixed: format
  const int whole = eighths >= 0 ? eighths / 8 : -((7 - eighths) / 8);
  const auto part = static_cast<std::size_t>(eighths - 8 * whole);
  return static_cast<double>(kScaleMantissa[part]) / kMantissaUnit * exact_exp2(whole);
}

SpanTracks::SpanTracks(std::span<const SkinnedGof> gofs, const SkinnedSettings& settings,
                       bool may_drop)
    : gofs_(gofs), settings_(settings), may_drop_(may_drop) {
  for (const SkinnedGof& gof : gofs) {
    states_.emplace_back(gof.num_frames);
    num_frames_ += gof.num_frames;
  }
}

SpanTracks::Coded SpanTracks::code(std::span<const std::array<double, 3>> wanted,
                                   double unit) const {
  Coded coded{std::vector<Trajectory>(states_.size()), {}, states_};
  for (std::size_t g = 0; g < states_.size(); ++g) {
    const auto gof_values = wanted.first(gofs_[g].num_frames);
    wanted = wanted.subspan(gof_values.size());
    TrackState after = states_[g];
    TrackCost cost = code_trajectory(gof_values, unit, track_options(settings_), after,
                                     coded.gof_trajectories[g]);
    TrackCost left_out;
    for (const auto& value : gof_values) {
      for (const double x : value) left_out.error += x * x / (unit * unit);
    }
    if (may_drop_ && lagrangian_cost(left_out) < lagrangian_cost(cost)) {
      coded.gof_trajectories[g] = {};
      coded.gof_trajectories[g].trajectory_flag = false;
      cost = left_out;
    } else {
      coded.after[g] = std::move(after);
    }
    coded.cost.bits += cost.bits;
    coded.cost.error += cost.error;
  }
  return coded;
}

std::vector<Vec3i> SpanTracks::indices(const Coded& coded) const {
  std::vector<Vec3i> indices;
  indices.reserve(num_frames_);
  for (std::size_t g = 0; g < gofs_.size(); ++g) {
    if (coded.gof_trajectories[g].trajectory_flag) {
      const std::vector<Vec3i> part =
          recon_trajectory(coded.gof_trajectories[g], settings_.track_levels);
      indices.insert(indices.end(), part.begin(), part.end());
    } else {
      indices.resize(indices.size() + gofs_[g].num_frames);
    }
  }
  return indices;
}

int signed_width(std::int64_t magnitude) {
  return magnitude == 0 ? 1 : floor_log2(static_cast<std::uint64_t>(magnitude)) + 2;
}

bool set_scale(int scale_idx, std::span<const Vec3i> indices, Trajectory& trajectory) {
  trajectory.scale_idx = scale_idx;
  std::int64_t largest = 0;
  for (const Vec3i& value : indices) {
    for (const std::int32_t x : value) {
      const std::int64_t scaled = scale_temporal(x, scale_idx, kMaxTemporalBits + 1);
      largest = std::max(largest, scaled < 0 ? ~scaled : scaled);
    }
  }
  trajectory.temporal_bits = signed_width(largest);
  return trajectory.temporal_bits <= kMaxTemporalBits;
}

}  // namespace rlpc
