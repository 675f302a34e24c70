#include "encoder/skinned_gof/quantise/temporal_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/cluster_gof/cluster_gof.h"
#include "common/skinned_gof/recon/skinned_recon.h"
#include "encoder/gof/component_cost.h"
#include "encoder/gof/lagrangian.h"
#include "encoder/math/det_math.h"
#include "encoder/skinned_gof/quantise/track_coding.h"

namespace rlpc {
namespace {

// tuned (off: 1): Squared error of a temporal value relative to that of a spatial one, with
// bones. The residual of bone motion is confined to few vertices, so that its temporal values
// may be coarser.
constexpr double kTemporalErrorOfBones = 2.0;
// Products of steps, in eighths of an octave, have a scale_idx up to this one.
constexpr int kMostEighths = kMaxScaleIdx - 8 * 4;  // fixed: format
// Wanted values up to this limit fit their width, however they are rounded.
constexpr double kMostTemporal = 1 << (kTemporalIndexBits - 2);  // fixed: format

double largest_magnitude(const std::vector<double>& values) {
  double most = 0.0;
  for (const double x : values) most = std::max(most, std::abs(x));
  return most;
}

double power_of_eighths(int eighths) {
  constexpr double kMantissaUnit = 32768.0;  // fixed: format
  const int whole = eighths >= 0 ? eighths / 8 : -((7 - eighths) / 8);
  const auto part = static_cast<std::size_t>(eighths - 8 * whole);
  return static_cast<double>(kScaleMantissa[part]) / kMantissaUnit * exact_exp2(whole);
}

class TemporalCoder {
 public:
  TemporalCoder(const SkinnedAnalysis& analysis, const SkinnedSettings& settings, double step)
      : analysis_(analysis),
        settings_(settings),
        step_(step),
        num_vertices_(analysis.model.influences.size()) {
    for (const SkinnedGof& gof : analysis.gofs) {
      states_.emplace_back(gof.num_frames);
      num_frames_ += gof.num_frames;
    }
  }

  TemporalValues code(const TemporalLimits& limits) {
    TemporalValues values;
    values.of_gof.resize(analysis_.gofs.size());
    std::size_t& l = values.num_tried;
    for (; l < analysis_.pc.temporal.size() && values.size() < limits.max_trajectories; ++l) {
      if (!code(l, limits.least_eighths, values)) break;
    }
    return values;
  }

 private:
  // Codes a component with the step that gives equal distortion. False: the component is not
  // worth its bits.
  bool code(std::size_t l, int least_eighths, TemporalValues& values) {
    const std::size_t num_frames = num_frames_;
    const std::vector<double>& temporal = analysis_.pc.temporal[l];
    const int eighths = eighths_of(l, least_eighths);
    const double unit = power_of_eighths(eighths) / step_;
    std::vector<std::array<double, 3>> wanted(num_frames);
    for (std::size_t f = 0; f < num_frames; ++f) {
      for (std::size_t c = 0; c < 3; ++c) wanted[f][c] = temporal[c * num_frames + f];
    }
    std::vector<TrackState> after = states_;
    std::vector<Trajectory> trajectories(after.size());
    const TrackCost cost = code_tracks(wanted, unit, after, trajectories);
    const double saved = analysis_.pc.energy[l] * (1.0 - cost.error * unit * unit);
    if (saved < least_worth(cost.bits, l)) return false;
    states_ = std::move(after);
    values.eighths.push_back(eighths);
    std::vector<Vec3i>& indices = values.indices.emplace_back();
    for (std::size_t g = 0; g < trajectories.size(); ++g) {
      if (trajectories[g].trajectory_flag) {
        const std::vector<Vec3i> part =
            recon_trajectory(trajectories[g], settings_.track_levels);
        indices.insert(indices.end(), part.begin(), part.end());
      } else {
        indices.resize(indices.size() + analysis_.gofs[g].num_frames);
      }
      values.of_gof[g].push_back(std::move(trajectories[g]));
    }
    std::vector<double>& decoded = values.decoded.emplace_back(3 * num_frames);
    for (std::size_t f = 0; f < num_frames; ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        decoded[c * num_frames + f] = unit * values.indices.back()[f][c];
      }
    }
    return true;
  }

  // Codes a component, GOF by GOF; in a GOF of tracks, it need not occur.
  TrackCost code_tracks(std::span<const std::array<double, 3>> wanted, double unit,
                        std::span<TrackState> states,
                        std::span<Trajectory> trajectories) const {
    TrackCost sum;
    for (std::size_t g = 0; g < states.size(); ++g) {
      const auto of_gof = wanted.first(analysis_.gofs[g].num_frames);
      wanted = wanted.subspan(of_gof.size());
      TrackState after = states[g];
      TrackCost cost =
          code_trajectory(of_gof, unit, track_options(settings_), after, trajectories[g]);
      TrackCost left_out;
      for (const auto& value : of_gof) {
        for (const double x : value) left_out.error += x * x / (unit * unit);
      }
      if (states.size() > 1 && lagrangian_cost(left_out) < lagrangian_cost(cost)) {
        trajectories[g] = {};
        trajectories[g].trajectory_flag = false;
        cost = left_out;
      } else {
        states[g] = std::move(after);
      }
      sum.bits += cost.bits;
      sum.error += cost.error;
    }
    return sum;
  }

  // The exponent of the product of both steps, 2^(eighths / 8), which is what the stream codes.
  int eighths_of(std::size_t l, int least_eighths) const {
    const double error = has_bones() ? kTemporalErrorOfBones : kTemporalError;
    const double wanted = step_ * std::sqrt(error / importance(l)) * step_;
    const double least = step_ * largest_magnitude(analysis_.pc.temporal[l]) / kMostTemporal;
    return std::clamp(static_cast<int>(round_to_int(8.0 * det_log2(std::max(wanted, least)))),
                      least_eighths, kMostEighths);
  }

  // The energy that a trajectory must save: what its temporal values cost, and its spatial
  // factors cost and leave.
  double least_worth(double bits, std::size_t l) const {
    const double error = step_ * step_ / 12.0;
    const std::size_t width = analysis_.pc.temporal.size();
    const std::size_t places = analysis_.spatial_left.size() / width;
    double cost = 0.0;  // of a factor, on average
    for (std::size_t i = 0; i < places; ++i) {
      const double left = analysis_.spatial_left[i * width + l] / error;
      cost += expected_value_cost(left) / static_cast<double>(places);
    }
    return lambda(step_) * bits + error * cost * static_cast<double>(num_vertices_);
  }

  bool has_bones() const { return analysis_.model.bones.size() > 1; }

  // The weight of a squared error of a temporal value: the sum of squared spatial factors or,
  // as in Vasa and Skala 2009, (18) and (19), the squared sum of their magnitudes per vertex.
  double importance(std::size_t l) const {
    constexpr double kSmallest = 1e-12;  // fixed: above zero
    if (!settings_.cobra_steps) return analysis_.pc.energy[l];
    double sum = 0.0;
    const std::size_t width = analysis_.pc.temporal.size();
    for (std::size_t v = 0; v < num_vertices_; ++v) {
      sum += std::abs(double{analysis_.pc.spatial[v * width + l]});
    }
    return std::max(sum * sum / static_cast<double>(num_vertices_), kSmallest);
  }

  const SkinnedAnalysis& analysis_;
  const SkinnedSettings& settings_;
  double step_;
  std::size_t num_vertices_;
  std::size_t num_frames_ = 0;
  std::vector<TrackState> states_;  // [GOF]
};

}  // namespace

TemporalValues code_temporal_values(const SkinnedAnalysis& analysis,
                                    const SkinnedSettings& settings, double step,
                                    const TemporalLimits& limits) {
  return TemporalCoder(analysis, settings, step).code(limits);
}

}  // namespace rlpc
