#include "encoder/codec/kinds/skinned/quantise/skinned_gof_encoder.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/kinds/skinned/quantise/slice_cuts.h"
#include "encoder/codec/kinds/skinned/quantise/span_tracks.h"
#include "encoder/codec/kinds/skinned/quantise/spatial_values.h"
#include "encoder/codec/kinds/skinned/quantise/temporal_values.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/component_cost.h"

namespace rlpc {
namespace {

// Temporal values are scaled so that their step is 2^3 units of the sums, if possible.
constexpr int kWantedScaleIdx = 56;  // fixed: format

// Returns the frames of a GOF. `first`: the frame after the GOF before.
std::span<const Vec3i> frames_of(const SkinnedGof& gof, std::span<const Vec3i> values,
                                 std::size_t& first) {
  first += gof.num_frames;
  return values.subspan(first - gof.num_frames, gof.num_frames);
}

// Returns false if a temporal value exceeds the maximum width; the sums then need fewer
// fraction bits.
bool set_temporal_widths(const std::vector<int>& idx, int fraction_bits,
                         std::span<const SkinnedGof> gofs, TemporalValues& temporal) {
  for (std::size_t l = 0; l < temporal.size(); ++l) {
    std::size_t first = 0;
    for (std::size_t g = 0; g < gofs.size(); ++g) {
      Trajectory& t = temporal.gof_trajectories[g][l];
      const auto values = frames_of(gofs[g], temporal.indices[l], first);
      if (!t.trajectory_flag) continue;
      if (!set_scale(idx[l] + 8 * fraction_bits, values, t)) return false;
    }
  }
  return true;
}

// Sets widths and scales of the trajectories, with as many fraction bits in the sums as all
// temporal factors need, or as many as are given. Returns 0, or if the range of scales is too
// large, the excess in eighths of an octave. None: values are too large for the fraction bits.
std::optional<int> set_scales(const std::vector<std::int32_t>& largest,
                              std::span<const SkinnedGof> gofs, std::optional<int> given,
                              TemporalValues& temporal, int& fraction_bits) {
  std::vector<int> idx(temporal.size());
  fraction_bits = 0;
  for (std::size_t l = 0; l < idx.size(); ++l) {
    const int spatial_bits = signed_width(largest[l]);
    for (auto& trajectories : temporal.gof_trajectories)
      trajectories[l].spatial_bits = spatial_bits;
    const int shift = spatial_factor_bits(spatial_bits) - spatial_bits;
    idx[l] = temporal.eighths[l] + 8 * (4 - shift);
    fraction_bits = std::max(fraction_bits, (kWantedScaleIdx - idx[l] + 7) / 8);
  }
  const int max = *std::max_element(idx.begin(), idx.end());
  fraction_bits = std::clamp(fraction_bits, 0, kMaxFractionBits);
  while (fraction_bits > 0 && max + 8 * fraction_bits > kMaxScaleIdx) --fraction_bits;
  if (given && max + 8 * *given > kMaxScaleIdx) return std::nullopt;
  if (given) fraction_bits = *given;
  const int lacking = -(*std::min_element(idx.begin(), idx.end()) + 8 * fraction_bits);
  if (lacking > 0) return lacking;
  while (!set_temporal_widths(idx, fraction_bits, gofs, temporal)) {
    if (given) return std::nullopt;
    --fraction_bits;
  }
  return 0;
}

// Residuals of trajectories, [num_vertices][trajectory], and their slices.
struct CodedTrajectories {
  std::vector<std::int32_t> residual;
  SliceCuts cuts;
};

// Returns the expected bits of the spatial factors of the leading components, from prediction
// residuals.
double expected_spatial_bits(const SkinnedAnalysis& analysis, std::size_t count, double step) {
  const std::size_t width = analysis.pc.temporal.size();
  const std::size_t places = analysis.spatial_left.size() / width;
  const double error = step * step / 12.0;
  double bits = 0.0;
  for (std::size_t i = 0; i < places; ++i) {
    for (std::size_t l = 0; l < count; ++l) {
      bits += 0.5 * det_log2(1.0 + analysis.spatial_left[i * width + l] / error);
    }
  }
  return bits * static_cast<double>(analysis.rest[0].size()) / static_cast<double>(places);
}

// Adds trajectories to a span. Coarsens the steps if values do not fit their widths.
// shared: the shared rig of a local component group, or null; if values do not fit its
// fraction bits, there are no trajectories.
CodedTrajectories code_trajectories(const OrderedMesh& mesh, const SkinnedAnalysis& analysis,
                                    const SkinnedSettings& settings, double step,
                                    const RigRecon* shared, CodedSpan& coded) {
  constexpr double kReserve = 1.02;  // fixed: the next try fits
  SharedRig& rig = coded.rig;
  std::optional<int> fraction_bits;
  if (shared != nullptr) fraction_bits = rig.fraction_bits;
  TemporalLimits limits{
      std::min<std::size_t>(settings.max_trajectories, kLevels.back().max_components),
      settings.min_trajectories};
  for (;;) {
    TemporalValues temporal = code_temporal_values(analysis, settings, step, limits);
    if (temporal.size() == 0) return {{}, choose_slice_cuts(settings, 0.0, 0)};
    const std::size_t count = temporal.size();
    if (shared == nullptr) rig.weights.num_adaptive_factors = 0;
    if (shared == nullptr && rig.prediction == Prediction::kLayers) {
      rig.weights.num_adaptive_factors =
          std::min(settings.num_adaptive_factors, static_cast<std::uint32_t>(count));
    }
    constexpr double kAdaptive =
        0.42;  // fixed: part of the bits, with adaptive weights; an estimate
    const double bits = expected_spatial_bits(analysis, temporal.num_tried, step) *
                        (rig.weights.num_adaptive_factors > 0 ? kAdaptive : 1.0);
    SliceCuts cuts = choose_slice_cuts(settings, bits, count);
    SpatialValues spatial = code_spatial_values(mesh, rig, analysis, temporal, cuts.group_end,
                                                shared, settings.rounding, step);
    if (spatial.excess > 1.0) {
      step *= kReserve * spatial.excess;
      continue;
    }
    const std::optional<int> lacking =
        set_scales(spatial.largest, coded.gofs, fraction_bits, temporal, rig.fraction_bits);
    if (!lacking) return {{}, {}};
    if (*lacking == 0) {
      rig.trajectories.resize(count);
      for (std::size_t l = 0; l < count; ++l) {
        rig.trajectories[l].spatial_bits = temporal.gof_trajectories[0][l].spatial_bits;
      }
      for (std::size_t g = 0; g < coded.gofs.size(); ++g) {
        coded.gofs[g].trajectories = std::move(temporal.gof_trajectories[g]);
      }
      if (shared == nullptr) coded.values = std::move(spatial.values);
      return {std::move(spatial.residual), std::move(cuts)};
    }
    limits.min_eighths =
        *std::min_element(temporal.eighths.begin(), temporal.eighths.end()) + *lacking;
  }
}

}  // namespace

bool has_trajectories(std::size_t count, const SkinnedAnalysis& analysis,
                      const SkinnedSettings& settings, double step) {
  return code_temporal_values(analysis, settings, step, {count}).size() == count;
}

double expected_squared_error(const SkinnedAnalysis& analysis, double step) {
  const auto num_vertices = static_cast<double>(analysis.rest[0].size());
  std::size_t num_frames = 0;
  for (const SkinnedGof& gof : analysis.gofs) num_frames += gof.num_frames;
  double error = analysis.pc.total_energy;
  for (const double energy : analysis.pc.energy) {
    error -= energy - expected_component_error(energy, num_vertices,
                                               static_cast<double>(num_frames), step);
  }
  return error;
}

CodedSpan code_skinned_span(const OrderedMesh& mesh, const SkinnedAnalysis& analysis,
                            const SkinnedSettings& settings, double step) {
  CodedSpan coded{analysis.rig, analysis.gofs};
  SharedRig& rig = coded.rig;
  rig.weights = {settings.damping_log2, settings.outer_weight, settings.outer_scale};
  const CodedTrajectories trajectories =
      code_trajectories(mesh, analysis, settings, step, nullptr, coded);
  cut_slices(mesh, settings, trajectories.cuts, trajectories.residual, rig);
  return coded;
}

LocalGroup code_local_group(const OrderedMesh& mesh, const SkinnedAnalysis& analysis,
                            const RigRecon& shared, SkinnedSettings settings, double step) {
  settings.component_groups = 1;
  CodedSpan coded{analysis.rig, analysis.gofs};
  CodedTrajectories trajectories =
      code_trajectories(mesh, analysis, settings, step, &shared, coded);
  return {std::move(coded.gofs.front().trajectories), std::move(trajectories.residual)};
}

void add_local_group(LocalGroup group, SkinnedGof& gof) {
  if (group.trajectories.empty()) return;
  ++gof.num_local_groups;
  gof.group_end.push_back(gof.group_end.back() + group.trajectories.size());
  gof.slice_layers.push_back(static_cast<std::uint32_t>(gof.layer_group_size.size()));
  gof.vertex_residual.resize(gof.num_local_groups);
  gof.vertex_residual.push_back(std::move(group.residual));
  for (Trajectory& t : group.trajectories) gof.trajectories.push_back(std::move(t));
}

SkinnedGof merge_into_gof(CodedSpan coded) {
  SkinnedGof gof = std::move(coded.gofs.front());
  std::vector<Bone> bones = std::move(gof.bones);
  std::vector<Trajectory> trajectories = std::move(gof.trajectories);
  static_cast<SharedRig&>(gof) = std::move(coded.rig);
  gof.bones = std::move(bones);
  gof.trajectories = std::move(trajectories);
  return gof;
}

void use_rig(std::shared_ptr<const SharedRig> rig, SkinnedGof& gof) {
  gof.kind = GofKind::kSharedRig;
  gof.fraction_bits = rig->fraction_bits;
  gof.weight_bits = rig->weight_bits;
  gof.prediction = rig->prediction;
  gof.weights = rig->weights;
  gof.stretch_flag = rig->stretch_flag;
  gof.layer_group_size = rig->layer_group_size;
  gof.layer_step = rig->layer_step;
  gof.num_component_groups = rig->num_component_groups;
  gof.group_end = {rig->group_end.back()};
  gof.slice_layers = rig->slice_layers;
  gof.rig = std::move(rig);
}

}  // namespace rlpc
