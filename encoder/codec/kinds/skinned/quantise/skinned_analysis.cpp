#include "encoder/codec/kinds/skinned/quantise/skinned_analysis.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/quantise/mean_motion.h"
#include "encoder/codec/kinds/skinned/quantise/span_bones.h"
#include "encoder/codec/kinds/skinned/quantise/spatial_left.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/small_system.h"
#include "encoder/codec/rest/rest_coding.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {
namespace {

// tuned (off: 1): Quantiser step of a layer relative to that of the next finer layer. Vertices
// of coarse layers predict those of finer ones, so their errors spread.
constexpr double kFinerLayer = 0.9;
// tuned (off: 1): Smallest quantiser step of a layer relative to that of the finest layer.
// Coarser layers have so few vertices that their errors barely count.
constexpr double kFinestLayer = 0.4;
constexpr std::size_t kVerticesTogether = 32;  // fixed: vertices of a pass
constexpr double kMinMass = 1e-3;              // fixed: above zero

std::uint32_t step_idx(double step) {
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(
      round_to_int(8.0 * det_log2(std::max(step, 1.0))), 0, kMaxStepIdx));
}

std::vector<std::uint8_t> layer_steps(std::size_t num_layers, bool finer) {
  std::vector<std::uint8_t> steps(num_layers, kMaxLayerStep);
  double step = kMaxLayerStep;
  for (std::size_t i = num_layers; i-- > 0 && finer; step *= kFinerLayer) {
    steps[i] =
        static_cast<std::uint8_t>(round_to_int(std::max(step, kFinestLayer * kMaxLayerStep)));
  }
  return steps;
}

// Rounds weights to integers with sum `total`; the largest weight absorbs the rounding error.
Influences quantise_weights(const std::vector<RigWeight>& weights, int total) {
  std::vector<std::pair<int, std::uint32_t>> rounded;
  for (const RigWeight& w : weights) {
    const auto units = static_cast<int>(round_to_int(w.weight * total));
    if (units > 0) rounded.push_back({units, w.bone});
  }
  std::sort(rounded.begin(), rounded.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  if (rounded.empty()) rounded.push_back({total, weights.front().bone});
  if (rounded.size() > kMaxExtraBones) rounded.resize(kMaxExtraBones);
  int sum = 0;
  for (const auto& [units, bone] : rounded) sum += units;
  rounded.front().first += total - sum;
  Influences influences;
  for (const auto& [units, bone] : rounded) {
    if (units <= 0) continue;
    influences.list[influences.size++] = {static_cast<std::uint16_t>(bone),
                                          static_cast<std::uint16_t>(units)};
  }
  return influences;
}

}  // namespace

TrackOptions track_options(const SkinnedSettings& settings) {
  return {.refine = settings.temporal_weights,
          .nearest = settings.rounding == Rounding::kNearest,
          .track_levels = settings.track_levels,
          .only_levels = settings.temporal_layers > 1,
          .fast = settings.rounding == Rounding::kDeadZone,
          .draft = settings.draft};
}

namespace {

class SkinnedAnalyser {
 public:
  SkinnedAnalyser(const OrderedMesh& mesh, int position_bits, const SpanFrames& frames,
                  const Rig& rig, const SkinnedSettings& settings, double step,
                  const SkinnedAnalysis* before)
      : mesh_(mesh),
        position_bits_(position_bits),
        frames_(frames),
        rig_(rig),
        settings_(settings),
        step_(step),
        before_(before) {}

  SkinnedAnalysis analyse() {
    const Stage stage("quantisation");
    SharedRig& rig = found_.rig;
    rig.weight_bits = rig_.bones.size() > 1 ? settings_.weight_bits : 0;
    rig.prediction = settings_.prediction;
    rig.layer_group_size = {mesh_.num_layers()};
    rig.layer_step = layer_steps(mesh_.num_layers(), settings_.layer_steps);
    rig.slice_layers = {1};
    if (before_ != nullptr && settings_.draft) {
      found_.gofs = before_->gofs;
      found_.bones = before_->bones;
      rig.stretch_flag = before_->rig.stretch_flag;
      rig.bones = before_->rig.bones;
      rig.influences = before_->rig.influences;
    } else {
      found_.gofs = gofs_of_span(frames_, settings_.track_levels);
      code_bones();
      for (const auto& weights : rig_.weights) {
        rig.influences.push_back(quantise_weights(weights, 1 << rig.weight_bits));
      }
    }
    for (const BoneMotion& bone : found_.bones) {
      motions_.push_back(motions_of(bone, 0, frames_.num_frames));
    }
    code_rest();
    if (before_ != nullptr) {
      // Bones and rest positions differ by errors of their quantisers.
      found_.pc = before_->pc;
      found_.step_of_components = before_->step_of_components;
    } else {
      // A component of less energy than the error of quantising its factors is not worth a
      // trajectory. Steps that are tried later may be finer.
      const double finest = step_ / (settings_.draft ? kDraftServes : kAnalysisServes);
      const double min = finest * finest / 12.0 * frames_.num_vertices;
      const Stage components("components");
      found_.pc = components_by_row(displacement(), settings_.max_trajectories, min);
      found_.step_of_components = step_;
    }
    found_.spatial_left = find_spatial_left(mesh_, found_.pc);
    return std::move(found_);
  }

 private:
  // Returns which bones descend from a bone; it does so itself.
  std::vector<bool> descendants(std::size_t b) const {
    std::vector<bool> descends(rig_.bones.size());
    descends[b] = true;
    for (std::size_t k = b + 1; k < descends.size(); ++k) {
      const std::int32_t parent = rig_.bones[k].parent;
      descends[k] = parent >= 0 && descends[static_cast<std::size_t>(parent)];
    }
    return descends;
  }

  // Returns the sum of the squared weights of some bones, and of the squared weights times the
  // squared distances from the pivot of bone b.
  std::pair<double, double> mass_and_moment(std::size_t b,
                                            const std::vector<bool>& bones) const {
    double mass = 0.0;
    double moment = 0.0;
    for (std::size_t v = 0; v < rig_.rest.size(); ++v) {
      for (const RigWeight& w : rig_.weights[v]) {
        if (!bones[w.bone]) continue;
        double square = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
          const double d = rig_.rest[v][c] - rig_.bones[b].pivot[c];
          square += d * d;
        }
        mass += w.weight * w.weight;
        moment += w.weight * w.weight * square;
      }
    }
    return {mass, moment};
  }

  void code_bones() {
    SpanBones bones(found_.gofs, track_options(settings_));
    const int limit = 1 << (rest_bits(position_bits_) - 1);
    for (std::size_t b = 0; b < rig_.bones.size(); ++b) {
      const RigBone& from = rig_.bones[b];
      Bone bone;
      bone.parent = from.parent;
      for (std::size_t c = 0; c < 3; ++c) {
        bone.pivot[c] = static_cast<std::int32_t>(std::clamp<std::int64_t>(
            round_to_int(from.pivot[c] * kPointScale), -limit, limit - 1));
      }
      bone.rotation_flag = from.rotates;
      bone.origin_flag = !from.pinned;
      std::vector<bool> only_b(rig_.bones.size());
      only_b[b] = true;
      const auto [mass, moment] = mass_and_moment(b, only_b);
      // A rotation with quaternion vector part x moves a point by 2 x r, r its distance from
      // the axis.
      const double turn_step =
          step_ / (2.0 * std::sqrt(std::max(moment * 2.0 / 3.0, kMinMass)));
      bone.rotation_step_idx = step_idx(turn_step * exact_exp2(kQuaternionFractionBits));
      bone.origin_step_idx =
          step_idx(step_ / std::sqrt(std::max(mass, kMinMass)) * kPointScale);
      if (from.stretch != Stretch::kNone) set_stretch(b, bone);
      std::vector<WantedPose> wanted(frames_.num_frames);
      for (std::size_t f = 0; f < wanted.size(); ++f) {
        wanted[f].rotation = from.poses[f].rotation;
        for (std::size_t c = 0; c < 3; ++c) {
          wanted[f].origin[c] = from.poses[f].origin[c] * kPointScale;
        }
      }
      bones.add(bone, std::move(wanted), from.axes);
      found_.rig.bones.push_back(std::move(bone));
      found_.rig.stretch_flag = found_.rig.stretch_flag || from.stretch != Stretch::kNone;
    }
    found_.bones = std::move(bones.motions());
  }

  void set_stretch(std::size_t b, Bone& bone) const {
    const RigBone& from = rig_.bones[b];
    bone.stretch = from.stretch;
    constexpr double kUnit = 1 << (kStretchAxisBits - 1);  // fixed: format
    for (std::size_t c = 0; c < 3; ++c) {
      const double part = from.stretch_turn[c + 1] / from.stretch_turn[0];
      bone.stretch_axes[c] = static_cast<std::int32_t>(
          std::clamp<std::int64_t>(round_to_int(part * kUnit), -32768, 32767));
    }
    // The error of a factor displaces a point by its distance along the axis, whose square is a
    // third of the squared distance on average. Descendants inherit the error.
    const double moment = mass_and_moment(b, descendants(b)).second;
    const double step = step_ / std::sqrt(std::max(moment / 3.0, kMinMass));
    bone.stretch_step_idx = step_idx(step * exact_exp2(kStretchFractionBits));
  }

  // Returns the least-squares rest position for the decoded bones.
  Point fit_rest(std::uint32_t v, MeanMotions& motions) const {
    const auto mean = motions.of(found_.rig.influences[v], found_.rig.weight_bits);
    SmallSystem<3> m;
    for (std::uint32_t f = 0; f < frames_.num_frames; ++f) {
      const MeanMotion& motion = mean[f];
      const double* x = frames_.at(f, v);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t k = 0; k < 3; ++k)
            m.a[i][k] += motion.turn[i][c] * motion.turn[k][c];
          m.b[i] += motion.turn[i][c] * (x[c] - motion.shift[c]);
        }
      }
    }
    const auto rest = solve_small(m);
    return rest.is_unique ? rest.x : rig_.rest[v];
  }

  // Codes the wanted positions by layers. Returns the values as decoded.
  std::vector<std::int32_t> code_rest_in_layers(std::span<const Point> wanted) {
    SharedRig& rig = found_.rig;
    std::vector<std::int32_t> values(kRestFactors * wanted.size());
    rig.vertex_residual.emplace_back(values.size());
    const ValuePrediction prediction(mesh_, true, nullptr);
    std::array<std::int64_t, kRestFactors> predicted{};
    for (const std::uint32_t v : mesh_.order()) {
      prediction.predict(v, values, predicted);
      const int layer_step = rig.layer_step[mesh_.layer_of(v)];
      const double unit = static_cast<double>(rig.rest_step) * layer_step / kMaxLayerStep;
      for (std::size_t c = 0; c < 3; ++c) {
        constexpr double kMax = static_cast<double>(kMaxResidual);  // fixed: format
        const double steps =
            (wanted[v][c] * kPointScale - static_cast<double>(predicted[c])) / unit;
        const auto residual =
            static_cast<std::int32_t>(round_to_int(std::clamp(steps, -kMax, kMax)));
        rig.vertex_residual[0][v * kRestFactors + c] = residual;
        values[v * kRestFactors + c] =
            clip_signed(rest_bits(position_bits_),
                        predicted[c] + rest_difference(rig, residual, layer_step));
      }
    }
    return values;
  }

  // Replaces residuals by those in an order of their own (8.18) if these cost less.
  void code_rest_in_order_of_its_own(std::span<const Point> wanted,
                                     std::vector<std::int32_t>& values) {
    SharedRig& rig = found_.rig;
    const double limit = exact_exp2(rest_bits(position_bits_) - 1);
    std::vector<std::int32_t> rounded;
    for (const Point& x : wanted) {
      for (const double coordinate : x) {
        rounded.push_back(static_cast<std::int32_t>(
            round_to_int(std::clamp(coordinate * kPointScale, -limit, limit - 1.0))));
      }
    }
    const bool counterparts = settings_.rest == RestTools::kCounterparts && !settings_.draft;
    RestEncoding coded =
        code_rest_in_order(mesh_, rounded, rig.rest_step, position_bits_,
                           {.few = settings_.draft, .counterparts = counterparts});
    if (!(coded.cost <
          rest_cost_in_layers(mesh_, rounded, rig.rest_step, rig.vertex_residual[0], values))) {
      return;
    }
    rig.rest = coded.settings;
    rig.vertex_residual[0] = std::move(coded.residual);
    rig.counterparts = std::move(coded.counterparts);
    values = std::move(coded.values);
  }

  void code_rest() {
    SharedRig& rig = found_.rig;
    const double rest_step =
        step_ / std::sqrt(static_cast<double>(frames_.num_frames)) * kPointScale;
    rig.rest_step = static_cast<std::uint32_t>(
        std::clamp<std::int64_t>(round_to_int(rest_step), 1, kMaxRestStep));
    const std::uint32_t n = frames_.num_vertices;
    std::vector<Point> wanted(n);
    for_ranges(n, kVerticesTogether, [&](std::size_t v, std::size_t end) {
      MeanMotions motions(motions_);
      for (; v < end; ++v) wanted[v] = fit_rest(static_cast<std::uint32_t>(v), motions);
    });
    std::vector<std::int32_t> values = code_rest_in_layers(wanted);
    if (settings_.rest != RestTools::kPrediction) code_rest_in_order_of_its_own(wanted, values);
    for (std::size_t c = 0; c < 3; ++c) {
      found_.rest[c].resize(n);
      for (std::uint32_t v = 0; v < n; ++v) found_.rest[c][v] = values[v * kRestFactors + c];
    }
  }

  // Returns the residual of bone motion: frames minus skinned rest positions.
  TrajectoryRows displacement() {
    const std::size_t width = 3 * std::size_t{frames_.num_frames};
    return {frames_.num_vertices, width,
            [this, width, chosen = numbers_from(0, frames_.num_frames)](
                std::size_t first, std::span<double> rows) {
              for_ranges(rows.size() / width, kVerticesTogether,
                         [&](std::size_t i, std::size_t end) {
                           MeanMotions motions(motions_);
                           for (; i < end; ++i) {
                             const auto v = static_cast<std::uint32_t>(first + i);
                             write_displacement(
                                 frames_, chosen, v,
                                 motions.of(found_.rig.influences[v], found_.rig.weight_bits),
                                 rest_of(v), &rows[i * width]);
                           }
                         });
            }};
  }

  // Returns the decoded rest position, in grid units.
  Point rest_of(std::uint32_t v) const {
    Point rest;
    for (std::size_t c = 0; c < 3; ++c) rest[c] = found_.rest[c][v] / kPointScale;
    return rest;
  }

  const OrderedMesh& mesh_;
  int position_bits_;
  const SpanFrames& frames_;
  const Rig& rig_;
  const SkinnedSettings& settings_;
  double step_;
  const SkinnedAnalysis* before_;
  SkinnedAnalysis found_;
  MotionsOfBones motions_;
};

}  // namespace

SkinnedAnalysis analyse_skinned_gof(const OrderedMesh& mesh, int position_bits,
                                    const SpanFrames& frames, const Rig& rig,
                                    const SkinnedSettings& settings, double step,
                                    const SkinnedAnalysis* before) {
  return SkinnedAnalyser(mesh, position_bits, frames, rig, settings, step, before).analyse();
}

}  // namespace rlpc
