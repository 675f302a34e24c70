#include "encoder/skinned_gof/quantise/skinned_gof_encoder.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "common/cluster_gof/cluster_gof.h"
#include "common/int_math.h"
#include "common/skinned_gof/recon/skinned_recon.h"
#include "common/syntax/sequence_header.h"
#include "encoder/skinned_gof/quantise/slice_cuts.h"
#include "encoder/skinned_gof/quantise/spatial_values.h"
#include "encoder/skinned_gof/quantise/temporal_values.h"

namespace rlpc {
namespace {

// Temporal values are scaled so that their step is 2^3 units of the sums, if possible.
constexpr int kWantedScaleIdx = 56;  // fixed: format

// Width in bits of a signed number of this magnitude.
int signed_width(std::int64_t magnitude) {
  return magnitude == 0 ? 1 : floor_log2(static_cast<std::uint64_t>(magnitude)) + 2;
}

// False if a temporal value exceeds the maximum width; the sums then need fewer fraction bits.
bool set_temporal_widths(const std::vector<int>& idx, int fraction_bits,
                         TemporalValues& temporal) {
  for (std::size_t l = 0; l < temporal.size(); ++l) {
    Trajectory& t = temporal.trajectories[l];
    t.scale_idx = idx[l] + 8 * fraction_bits;
    std::int64_t largest = 0;
    for (const Vec3i& value : temporal.indices[l]) {
      for (const std::int32_t x : value) {
        const std::int64_t scaled = scale_temporal(x, t.scale_idx, kMaxTemporalBits + 1);
        largest = std::max(largest, scaled < 0 ? ~scaled : scaled);
      }
    }
    t.temporal_bits = signed_width(largest);
    if (t.temporal_bits > kMaxTemporalBits) return false;
  }
  return true;
}

// Sets widths and scales of the trajectories, with as many fraction bits in the sums as all
// temporal factors need. Returns 0, or if the range of scales is too large, the excess in
// eighths of an octave.
int set_scales(const std::vector<std::int32_t>& largest, TemporalValues& temporal,
               int& fraction_bits) {
  std::vector<int> idx(temporal.size());
  fraction_bits = 0;
  for (std::size_t l = 0; l < idx.size(); ++l) {
    Trajectory& t = temporal.trajectories[l];
    t.spatial_bits = signed_width(largest[l]);
    const int shift = spatial_factor_bits(t.spatial_bits) - t.spatial_bits;
    idx[l] = temporal.eighths[l] + 8 * (4 - shift);
    fraction_bits = std::max(fraction_bits, (kWantedScaleIdx - idx[l] + 7) / 8);
  }
  const int most = *std::max_element(idx.begin(), idx.end());
  fraction_bits = std::clamp(fraction_bits, 0, kMaxFractionBits);
  while (fraction_bits > 0 && most + 8 * fraction_bits > kMaxScaleIdx) --fraction_bits;
  const int lacking = -(*std::min_element(idx.begin(), idx.end()) + 8 * fraction_bits);
  if (lacking > 0) return lacking;
  while (!set_temporal_widths(idx, fraction_bits, temporal)) --fraction_bits;
  return 0;
}

// Residuals of trajectories, [num_vertices][trajectory], and their slices.
struct CodedTrajectories {
  std::vector<std::int32_t> residual;
  SliceCuts cuts;
};

// Adds trajectories to a GOF. Coarsens the steps if values do not fit their widths.
CodedTrajectories code_trajectories(const CodedMesh& mesh, const SkinnedAnalysis& analysis,
                                    const SkinnedSettings& settings, double step,
                                    SkinnedGof& gof) {
  constexpr double kReserve = 1.02;  // fixed: the next try fits
  TemporalLimits limits{kLevels.back().max_components};
  for (;;) {
    TemporalValues temporal = code_temporal_values(analysis, settings, step, limits);
    if (temporal.size() == 0) return {{}, choose_slice_cuts(settings, {}, 0)};
    const std::size_t count = temporal.size();
    const auto code = [&](std::span<const std::size_t> group_end) {
      return code_spatial_values(mesh, gof, analysis, temporal, group_end, settings.rounding,
                                 step);
    };
    gof.weights.num_adaptive_factors = 0;
    if (gof.prediction == Prediction::kLayers) {
      gof.weights.num_adaptive_factors =
          std::min(settings.num_adaptive_factors, static_cast<std::uint32_t>(count));
    }
    SpatialValues spatial = code(std::array{count});
    SliceCuts cuts = choose_slice_cuts(settings, spatial.residual, count);
    // Where groups begin, adaptive weights start afresh.
    if (gof.weights.num_adaptive_factors > 0 && cuts.group_end.size() > 1) {
      spatial = code(cuts.group_end);
    }
    if (spatial.excess > 1.0) {
      step *= kReserve * spatial.excess;
      continue;
    }
    const int lacking = set_scales(spatial.largest, temporal, gof.fraction_bits);
    if (lacking == 0) {
      gof.trajectories = std::move(temporal.trajectories);
      return {std::move(spatial.residual), std::move(cuts)};
    }
    limits.least_eighths =
        *std::min_element(temporal.eighths.begin(), temporal.eighths.end()) + lacking;
  }
}

}  // namespace

bool has_trajectories(std::size_t count, const SkinnedAnalysis& analysis,
                      const SkinnedSettings& settings, double step) {
  return code_temporal_values(analysis, settings, step, {count}).size() == count;
}

double expected_squared_error(const SkinnedAnalysis& analysis, double step) {
  // tuned (off: 1): Error of a coded value relative to that of a uniform quantiser, in the
  // forecast that starts the search. Most small values are rounded to zero and err by less than
  // half a step.
  constexpr double kOfCoded = 0.52;
  const double num_values = static_cast<double>(analysis.rest[0].size()) +
                            3.0 * kTemporalError * analysis.gof.num_frames;
  const double quantised = kOfCoded * step * step / 12.0 * num_values;
  double error = analysis.pc.total_energy;
  for (const double energy : analysis.pc.energy)
    error -= energy * energy / (energy + quantised);
  return error;
}

SkinnedGof code_skinned_gof(const CodedMesh& mesh, const SkinnedAnalysis& analysis,
                            const SkinnedSettings& settings, double step) {
  SkinnedGof gof = analysis.gof;
  gof.weights = {settings.damping_log2, settings.outer_weight, settings.outer_scale};
  const CodedTrajectories coded = code_trajectories(mesh, analysis, settings, step, gof);
  cut_slices(mesh, settings, coded.cuts, coded.residual, gof);
  return gof;
}

}  // namespace rlpc
