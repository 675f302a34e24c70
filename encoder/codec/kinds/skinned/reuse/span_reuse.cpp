#include "encoder/codec/kinds/skinned/reuse/span_reuse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "encoder/codec/kinds/skinned/quantise/skinned_gof_encoder.h"
#include "encoder/codec/kinds/skinned/quantise/span_bones.h"
#include "encoder/codec/kinds/skinned/quantise/span_tracks.h"
#include "encoder/codec/kinds/skinned/quantise/spatial_left.h"
#include "encoder/codec/kinds/skinned/quantise/temporal_values.h"
#include "encoder/codec/kinds/skinned/reuse/pose_fit.h"
#include "encoder/codec/kinds/skinned/reuse/rig_factors.h"
#include "encoder/codec/kinds/skinned/search/span_units.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/component_cost.h"
#include "encoder/codec/spans/lagrangian.h"
#include "encoder/codec/spans/sample_size.h"

namespace rlpc {
namespace {

class SpanReuse {
 public:
  SpanReuse(const SkinnedContext& context, const KeptRig& kept, const SpanFrames& frames,
            double step)
      : context_(context),
        kept_(kept),
        rig_(*kept.rig),
        mesh_(context.meshes[rig_.prediction]),
        frames_(frames),
        step_(step),
        settings_(usual_settings(context.settings)),
        poses_(rig_, kept.rest),
        factors_(kept) {
    settings_.prediction = rig_.prediction;
    const std::size_t max_factors =
        std::min<std::size_t>(settings_.max_trajectories, kLevels.back().max_components);
    settings_.max_trajectories = max_factors - std::min(max_factors, factors_.count());
  }

  double expected_cost() const;
  EncodedSpan encode();

 private:
  void code_bones();
  void code_trajectories();
  struct CodedTrajectory {
    SpanTracks::Coded tracks;
    std::vector<double> decoded;  // [3][num_frames]
  };
  std::optional<CodedTrajectory> code_trajectory(std::size_t l, std::span<const double> wanted,
                                                 const SpanTracks& tracks) const;
  int eighths_of(std::size_t l, double largest) const;
  LocalGroup local_group(const FrameRange& span) const;
  // Returns the residual in frames of the span. has_temporal: after the decoded temporal
  // values.
  RigRemainder remainder(const FrameRange& span, bool has_temporal) const;
  double min_energy() const { return step_ * step_ / 12.0 * frames_.num_vertices; }

  const SkinnedContext& context_;
  const KeptRig& kept_;
  const SharedRig& rig_;
  const OrderedMesh& mesh_;
  const SpanFrames& frames_;
  double step_;
  SkinnedSettings settings_;  // max_trajectories: maximum in a local component group
  PoseFit poses_;
  RigFactors factors_;
  // Results of coding.
  std::vector<SkinnedGof> gofs_;
  std::vector<BoneMotion> bones_;
  std::vector<double> temporal_;  // [trajectory][3][num_frames]
};

// Returns the least expected cost of local component groups and their residuals, from a sample
// of the frames. Bones and trajectories of the rig are assumed exact and free.
double SpanReuse::expected_cost() const {
  constexpr std::uint32_t kFrames = 12;  // fixed: enough to reject a span
  const std::uint32_t count = std::min(kFrames, frames_.num_frames);
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < count; ++i) {
    chosen.push_back(static_cast<std::uint32_t>(
        (2 * std::uint64_t{i} + 1) * frames_.num_frames / (2 * std::uint64_t{count})));
  }
  MotionsOfBones motions(rig_.bones.size());
  for (const std::uint32_t f : chosen) {
    const auto fitted = poses_.fit(frames_, std::span(&f, 1));
    for (std::size_t b = 0; b < motions.size(); ++b) {
      motions[b].push_back(
          motions_of(rig_.bones[b].pivot, fitted[b].poses, fitted[b].axes).front());
    }
  }
  RigRemainder left(kept_, factors_, frames_, chosen, std::move(motions));
  left.set_temporal(factors_.fit(left.rows()));
  const double frames_in_gof = static_cast<double>(frames_.num_frames) / frames_.num_gofs;
  const double part = frames_in_gof / count;
  const ComponentsByRow pc = components_by_row(left.rows(), left.width(), min_energy() / part);
  const std::vector<float> spatial_left = find_spatial_left(mesh_, pc);
  const std::size_t width = pc.temporal.size();
  double cost = part * pc.total_energy;  // cost of a GOF
  for (std::size_t l = 0; l < width; ++l) {
    double mean = 0.0;
    const std::size_t places = spatial_left.size() / width;
    for (std::size_t i = 0; i < places; ++i) {
      mean += double{spatial_left[i * width + l]} / static_cast<double>(places);
    }
    const double energy = part * pc.energy[l];
    cost -= energy - expected_component_cost(energy, frames_.num_vertices, 3.0 * frames_in_gof,
                                             part * mean, step_);
  }
  return cost * frames_.num_gofs;
}

void SpanReuse::code_bones() {
  gofs_ = gofs_of_span(frames_, settings_.track_levels);
  SpanBones bones(gofs_, track_options(settings_));
  auto fitted = poses_.fit(frames_, numbers_from(0, frames_.num_frames));
  for (std::size_t b = 0; b < fitted.size(); ++b) {
    bones.add(rig_.bones[b], std::move(fitted[b].poses), fitted[b].axes);
  }
  bones_ = std::move(bones.motions());
}

RigRemainder SpanReuse::remainder(const FrameRange& span, bool has_temporal) const {
  MotionsOfBones motions;
  for (const BoneMotion& bone : bones_)
    motions.push_back(motions_of(bone, span.first, span.count));
  RigRemainder left(kept_, factors_, frames_, numbers_from(span.first, span.count),
                    std::move(motions));
  if (!has_temporal || factors_.count() == 0) return left;
  std::vector<double> temporal;
  temporal.reserve(factors_.count() * left.width());
  for (std::size_t row = 0; row < 3 * factors_.count(); ++row) {
    const double* from = &temporal_[row * frames_.num_frames + span.first];
    temporal.insert(temporal.end(), from, from + span.count);
  }
  left.set_temporal(std::move(temporal));
  return left;
}

// Returns the exponent of the step of temporal values, 2^(eighths / 8), with the meaning that
// it has in TemporalValues. largest: largest magnitude of the values.
int SpanReuse::eighths_of(std::size_t l, double largest) const {
  const double wanted =
      step_ * std::sqrt(temporal_error(rig_, frames_.num_frames) / factors_.energy(l));
  return static_cast<int>(
      round_to_int(8.0 * det_log2(std::max(wanted, largest / kMaxTemporal))));
}

// Codes a trajectory of the rig. wanted: [3][num_frames]. None: its values do not fit.
std::optional<SpanReuse::CodedTrajectory> SpanReuse::code_trajectory(
    std::size_t l, std::span<const double> wanted, const SpanTracks& tracks) const {
  const double largest =
      std::abs(*std::max_element(wanted.begin(), wanted.end(),
                                 [](double a, double b) { return std::abs(a) < std::abs(b); }));
  if (!(factors_.energy(l) > 0.0 && largest > 0.0)) return std::nullopt;
  const int spatial_bits = rig_.trajectories[l].spatial_bits;
  const int shift = spatial_factor_bits(spatial_bits) - spatial_bits;
  const int scale_shift = 8 * (4 - shift + rig_.fraction_bits);  // scale_idx minus eighths
  const int scale_idx = std::max(eighths_of(l, largest) + scale_shift, 0);
  if (scale_idx > kMaxScaleIdx) return std::nullopt;
  const double unit = power_of_eighths(scale_idx - scale_shift);
  const std::size_t num_frames = frames_.num_frames;
  std::vector<std::array<double, 3>> values(num_frames);
  for (std::size_t f = 0; f < num_frames; ++f) {
    for (std::size_t c = 0; c < 3; ++c) values[f][c] = wanted[c * num_frames + f];
  }
  CodedTrajectory found{tracks.code(values, unit), std::vector<double>(3 * num_frames)};
  const std::vector<Vec3i> indices = tracks.indices(found.tracks);
  std::size_t first = 0;
  for (std::size_t g = 0; g < gofs_.size(); ++g) {
    const auto gof_indices = std::span(indices).subspan(first, gofs_[g].num_frames);
    first += gof_indices.size();
    Trajectory& t = found.tracks.gof_trajectories[g];
    t.spatial_bits = spatial_bits;
    if (t.trajectory_flag && !set_scale(scale_idx, gof_indices, t)) return std::nullopt;
  }
  for (std::size_t f = 0; f < num_frames; ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      found.decoded[c * num_frames + f] = unit * indices[f][c];
    }
  }
  return found;
}

void SpanReuse::code_trajectories() {
  const FrameRange all{0, frames_.num_frames};
  const std::vector<double> wanted = factors_.fit(remainder(all, false).rows());
  SpanTracks tracks(gofs_, settings_, true);
  const std::size_t width = 3 * std::size_t{frames_.num_frames};
  temporal_.assign(wanted.size(), 0.0);
  for (std::size_t l = 0; l < factors_.count(); ++l) {
    auto coded = code_trajectory(l, std::span(wanted).subspan(l * width, width), tracks);
    if (coded) {
      tracks.follow(coded->tracks);
      std::copy(coded->decoded.begin(), coded->decoded.end(), &temporal_[l * width]);
    }
    for (std::size_t g = 0; g < gofs_.size(); ++g) {
      Trajectory& t = gofs_[g].trajectories.emplace_back();
      t.trajectory_flag = false;
      if (coded) t = std::move(coded->tracks.gof_trajectories[g]);
    }
  }
}

LocalGroup SpanReuse::local_group(const FrameRange& span) const {
  if (settings_.max_trajectories == 0) return {};
  RigRemainder left = remainder(span, true);
  SkinnedAnalysis analysis;
  analysis.rig = rig_;
  analysis.rig.trajectories.clear();
  analysis.gofs.resize(1);
  analysis.gofs[0].num_frames = span.count;
  analysis.gofs[0].track_levels = settings_.track_levels;
  analysis.rest = kept_.rest;
  analysis.pc = components_by_row(left.rows(), settings_.max_trajectories, min_energy());
  analysis.spatial_left = find_spatial_left(mesh_, analysis.pc);
  return code_local_group(mesh_, analysis, *kept_.recon, settings_, step_);
}

EncodedSpan SpanReuse::encode() {
  code_bones();
  code_trajectories();
  const SpanUnits units(mesh_, context_.header, settings_.temporal_layers);
  std::vector<LocalGroup> groups(gofs_.size());
  EncodedSpan without = units.with_earlier_rig(kept_, gofs_, groups);
  const std::vector<FrameRange> spans = frames_.gofs();
  bool has_groups = false;
  for (std::size_t g = 0; g < spans.size(); ++g) {
    groups[g] = local_group(spans[g]);
    has_groups = has_groups || !groups[g].trajectories.empty();
  }
  if (!has_groups) return without;
  EncodedSpan with = units.with_earlier_rig(kept_, std::move(gofs_), std::move(groups));
  const double cost = lagrangian_cost(with, frames_, step_);
  return cost < lagrangian_cost(without, frames_, step_) ? std::move(with) : std::move(without);
}

}  // namespace

std::optional<EncodedSpan> encode_with_rig(const SkinnedContext& context, const KeptRig& kept,
                                           const SpanFrames& frames, double step,
                                           double max_cost) {
  // tuned (off: 1e9): A span is encoded with an earlier rig if its expected cost is at most
  // this multiple of what it must not exceed. Expectations are too high: they leave out that
  // weights of prediction adapt.
  constexpr double kHopeful = 2.0;
  SpanReuse reuse(context, kept, frames, step);
  if (std::isfinite(max_cost) && reuse.expected_cost() > kHopeful * max_cost)
    return std::nullopt;
  EncodedSpan encoded = reuse.encode();
  if (std::isfinite(max_cost) && lagrangian_cost(encoded, frames, step) >= max_cost) {
    return std::nullopt;
  }
  return encoded;
}

}  // namespace rlpc
