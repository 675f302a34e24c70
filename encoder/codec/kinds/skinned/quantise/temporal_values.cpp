#include "encoder/codec/kinds/skinned/quantise/temporal_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/codec/kinds/cluster/cluster_gof.h"
#include "encoder/codec/kinds/skinned/quantise/span_tracks.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/component_cost.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// Products of steps, in eighths of an octave, have a scale_idx up to this one.
constexpr int kMaxEighths = kMaxScaleIdx - 8 * 4;  // fixed: format

// tuned (off: 1): Largest factor of kTemporalError in the High profile, where spatial factors
// adapt to decoded temporal values and make up for their errors.
constexpr double kLargestFactor = 2.4;
// tuned: Spatial factors for each temporal value of a trajectory, from which on that factor
// exceeds 1. The more vertices, the less of the rate temporal values take.
constexpr double kFactorsOfValue = 2.0;

// Whether a rig has one bone, and spatial factors that are predicted in layers.
bool has_layers_of_factors(const SharedRig& rig) {
  return rig.bones.size() == 1 && rig.prediction == Prediction::kLayers;
}

double largest_magnitude(const std::vector<double>& values) {
  double max = 0.0;
  for (const double x : values) max = std::max(max, std::abs(x));
  return max;
}

class TemporalCoder {
 public:
  TemporalCoder(const SkinnedAnalysis& analysis, const SkinnedSettings& settings, double step)
      : analysis_(analysis),
        settings_(settings),
        step_(step),
        num_vertices_(analysis.rig.influences.size()),
        tracks_(analysis.gofs, settings, analysis.gofs.size() > 1) {}

  TemporalValues code(const TemporalLimits& limits) {
    TemporalValues values;
    values.gof_trajectories.resize(analysis_.gofs.size());
    std::size_t& l = values.num_tried;
    for (; l < analysis_.pc.temporal.size() && values.size() < limits.max_trajectories; ++l) {
      if (!code(l, limits, values)) break;
    }
    return values;
  }

 private:
  // Codes a component with the step that gives equal distortion. False: the component is not
  // worth its bits.
  bool code(std::size_t l, const TemporalLimits& limits, TemporalValues& values) {
    const std::size_t num_frames = tracks_.num_frames();
    const std::vector<double>& temporal = analysis_.pc.temporal[l];
    const int eighths = eighths_of(l, limits.min_eighths);
    const double unit = power_of_eighths(eighths) / step_;
    std::vector<std::array<double, 3>> wanted(num_frames);
    for (std::size_t f = 0; f < num_frames; ++f) {
      for (std::size_t c = 0; c < 3; ++c) wanted[f][c] = temporal[c * num_frames + f];
    }
    SpanTracks::Coded coded = tracks_.code(wanted, unit);
    const double saved = analysis_.pc.energy[l] * (1.0 - coded.cost.error * unit * unit);
    if (l >= limits.min_trajectories && saved < min_worth(coded.cost.bits, l)) return false;
    values.eighths.push_back(eighths);
    values.indices.push_back(tracks_.indices(coded));
    tracks_.follow(coded);
    for (std::size_t g = 0; g < coded.gof_trajectories.size(); ++g) {
      values.gof_trajectories[g].push_back(std::move(coded.gof_trajectories[g]));
    }
    std::vector<double>& decoded = values.decoded.emplace_back(3 * num_frames);
    for (std::size_t f = 0; f < num_frames; ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        decoded[c * num_frames + f] = unit * values.indices.back()[f][c];
      }
    }
    return true;
  }

  // Returns the exponent of the product of both steps, 2^(eighths / 8), which the stream codes.
  int eighths_of(std::size_t l, int min_eighths) const {
    const double error = temporal_error(analysis_.rig, tracks_.num_frames());
    const double wanted = step_ * std::sqrt(error / importance(l)) * step_;
    const double min = step_ * largest_magnitude(analysis_.pc.temporal[l]) / kMaxTemporal;
    return std::clamp(static_cast<int>(round_to_int(8.0 * det_log2(std::max(wanted, min)))),
                      min_eighths, kMaxEighths);
  }

  // Returns the energy that a trajectory must save: the cost of its temporal values, and the
  // cost and error of its spatial factors.
  double min_worth(double bits, std::size_t l) const {
    const double error = step_ * step_ / 12.0;
    const std::size_t width = analysis_.pc.temporal.size();
    const std::size_t places = analysis_.spatial_left.size() / width;
    double cost = 0.0;  // mean cost of a factor
    for (std::size_t i = 0; i < places; ++i) {
      const double left = analysis_.spatial_left[i * width + l] / error;
      cost += expected_value_cost(left) / static_cast<double>(places);
    }
    return lambda(step_) * bits + error * cost * static_cast<double>(num_vertices_);
  }

  // Returns the weight of a squared error of a temporal value: the sum of squared spatial
  // factors or, as in Vasa and Skala 2009, (18) and (19), the squared sum of their magnitudes
  // per vertex.
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
  SpanTracks tracks_;
};

}  // namespace

double temporal_error(const SharedRig& rig, std::size_t num_frames) {
  if (rig.bones.size() > 1) return kTemporalErrorOfBones;
  if (!has_layers_of_factors(rig)) return kTemporalError;
  const double factors_of_value =
      static_cast<double>(rig.influences.size()) / (3.0 * static_cast<double>(num_frames));
  return kTemporalError * std::clamp(factors_of_value / kFactorsOfValue, 1.0, kLargestFactor);
}

TemporalValues code_temporal_values(const SkinnedAnalysis& analysis,
                                    const SkinnedSettings& settings, double step,
                                    const TemporalLimits& limits) {
  return TemporalCoder(analysis, settings, step).code(limits);
}

}  // namespace rlpc
