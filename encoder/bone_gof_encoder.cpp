#include "encoder/bone_gof_encoder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/gof.h"
#include "common/int_math.h"
#include "encoder/det_math.h"
#include "encoder/matrix_products.h"
#include "encoder/track_coding.h"

namespace rlpc {
namespace {

constexpr double kPointScale = 16.0;  // 1 << kPointFractionBits
// Steps of the layers before the finest, in sixteenths: 0.9^n, not below 0.4.
constexpr std::array<int, 10> kLayerSteps{16, 14, 13, 12, 10, 9, 9, 8, 7, 6};
// A slice is worth having if it holds about this much.
constexpr double kBytesOfSlice = 4000.0;
// Temporal values are scaled so that their step is 2^3 units of the sums, if that can be.
constexpr int kWantedScaleIdx = 56;

std::uint32_t step_idx(double step) {
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(
      round_to_int(8.0 * det_log2(std::max(step, 1.0))), 0, kMaxStepIdx));
}

// Energy below which a trajectory costs more than it saves: it has spatial factors that are
// small and cheap, and a temporal vector that is not.
double least_energy(double step, std::uint32_t num_vertices, std::uint32_t num_frames) {
  constexpr double kOfSpatial = 0.25;  // squared errors of a coded value
  constexpr double kOfTemporal = 12.0;
  const double share = static_cast<double>(num_frames) / num_vertices;
  const double values = std::clamp(kOfSpatial + kOfTemporal * share, 0.4, 1.2);
  return values * step * step / 12.0 * num_vertices;
}

std::vector<std::uint8_t> layer_steps(std::size_t num_layers, bool finer) {
  std::vector<std::uint8_t> steps(num_layers, kMaxLayerStep);
  for (std::size_t i = 0; i < num_layers && finer; ++i) {
    steps[i] = static_cast<std::uint8_t>(
        kLayerSteps[std::min(num_layers - 1 - i, kLayerSteps.size() - 1)]);
  }
  return steps;
}

// Weights to integers that sum to `total`; what rounding leaves goes to the largest.
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

// A motion, or the mean of some: world = turn * rest + shift, in grid units.
struct MeanMotion {
  std::array<Point, 3> turn{};  // columns: images of the axes
  Point shift{};
};

// The motion of a decoded bone in each frame.
std::vector<MeanMotion> motions_of(const BoneMotion& bone) {
  const double axis_unit = exact_exp2(-kQuaternionFractionBits);
  std::vector<MeanMotion> motions(bone.poses.size());
  for (std::size_t f = 0; f < motions.size(); ++f) {
    const BonePose& pose = bone.poses[f];
    for (std::size_t c = 0; c < 3; ++c) {
      double moved = static_cast<double>(pose.origin[c]);
      for (std::size_t k = 0; k < 3; ++k) {
        const double a = static_cast<double>(pose.axes[k][c]) * axis_unit;
        motions[f].turn[k][c] = a;
        moved -= a * static_cast<double>(bone.pivot[k]);
      }
      motions[f].shift[c] = moved / kPointScale;
    }
  }
  return motions;
}

// Solves the symmetric m x = b by elimination; false if m is singular.
bool solve3(std::array<std::array<double, 4>, 3> m, Point& x) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(m[i][i] > 0.0)) return false;
    for (std::size_t r = i + 1; r < 3; ++r) {
      const double factor = m[r][i] / m[i][i];
      for (std::size_t k = i; k < 4; ++k) m[r][k] -= factor * m[i][k];
    }
  }
  for (std::size_t i = 3; i-- > 0;) {
    double sum = m[i][3];
    for (std::size_t k = i + 1; k < 3; ++k) sum -= m[i][k] * x[k];
    x[i] = sum / m[i][i];
  }
  return true;
}

class BoneAnalyser {
 public:
  BoneAnalyser(const CodedMesh& mesh, int position_bits, const GofFrames& frames,
               const Rig& rig, const BoneSettings& settings, double step)
      : mesh_(mesh),
        position_bits_(position_bits),
        frames_(frames),
        rig_(rig),
        settings_(settings),
        step_(step) {}

  BoneAnalysis analyse(std::uint32_t first_frame) {
    BoneGof& gof = found_.gof;
    gof.first_frame = first_frame;
    gof.num_frames = frames_.num_frames;
    gof.weight_bits = rig_.bones.size() > 1 ? settings_.weight_bits : 0;
    gof.prediction = settings_.prediction;
    gof.damping_log2 = settings_.damping_log2;
    gof.outer_weight = settings_.outer_weight;
    gof.outer_scale = settings_.outer_scale;
    gof.layer_group_size = {mesh_.num_layers()};
    gof.layer_step = layer_steps(mesh_.num_layers(), settings_.layer_steps);
    gof.slice_layers = {1};
    code_bones();
    for (const auto& weights : rig_.weights) {
      gof.influences.push_back(quantise_weights(weights, 1 << gof.weight_bits));
    }
    code_rest();
    // Steps that are tried later may be finer.
    constexpr double kReserve = 0.4;
    const double least =
        kReserve * least_energy(step_, frames_.num_vertices, frames_.num_frames);
    found_.pc = principal_components(displacement(), settings_.max_trajectories, least);
    const std::size_t count = found_.pc.spatial.size();
    found_.spatial.resize(frames_.num_vertices * count);
    for (std::size_t l = 0; l < count; ++l) {
      for (std::size_t v = 0; v < frames_.num_vertices; ++v) {
        found_.spatial[v * count + l] = found_.pc.spatial[l][v];
      }
    }
    found_.pc.spatial.clear();
    return std::move(found_);
  }

 private:
  // Squared weights of a bone, and their mean squared distance from the pivot.
  std::pair<double, double> reach(std::size_t b) const {
    double mass = 0.0;
    double moment = 0.0;
    for (std::size_t v = 0; v < rig_.rest.size(); ++v) {
      for (const RigWeight& w : rig_.weights[v]) {
        if (w.bone != b) continue;
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
    TrackState rotations(frames_.num_frames);
    TrackState origins(frames_.num_frames);
    found_.bones.reserve(rig_.bones.size());
    const int limit = 1 << (rest_bits(position_bits_) - 1);
    for (std::size_t b = 0; b < rig_.bones.size(); ++b) {
      const RigBone& from = rig_.bones[b];
      Bone bone;
      bone.parent = from.parent;
      for (std::size_t c = 0; c < 3; ++c) {
        bone.pivot[c] = static_cast<std::int32_t>(std::clamp<std::int64_t>(
            round_to_int(from.pivot[c] * kPointScale), -limit, limit - 1));
      }
      bone.rotation_flag = from.turns;
      bone.origin_flag = !from.pinned;
      const auto [mass, moment] = reach(b);
      // A turn by a quaternion's vector part x moves a point at distance r by 2 x r, across.
      const double turn_step = step_ / (2.0 * std::sqrt(std::max(moment * 2.0 / 3.0, 1e-3)));
      bone.rotation_step_idx = step_idx(turn_step * exact_exp2(kQuaternionFractionBits));
      bone.origin_step_idx = step_idx(step_ / std::sqrt(std::max(mass, 1e-3)) * kPointScale);
      std::vector<WantedPose> wanted(frames_.num_frames);
      for (std::size_t f = 0; f < wanted.size(); ++f) {
        wanted[f].rotation = from.poses[f].rotation;
        for (std::size_t c = 0; c < 3; ++c) {
          wanted[f].origin[c] = from.poses[f].origin[c] * kPointScale;
        }
      }
      const BoneMotion* parent =
          bone.parent < 0 ? nullptr : &found_.bones[static_cast<std::size_t>(bone.parent)];
      found_.bones.push_back(code_bone(wanted, parent, rotations, origins, bone));
      motions_.push_back(motions_of(found_.bones.back()));
      found_.gof.bones.push_back(std::move(bone));
    }
  }

  // The mean motion of a vertex in each frame.
  void find_mean_motion(std::uint32_t v) {
    const Influences& influences = found_.gof.influences[v];
    const double unit = exact_exp2(-found_.gof.weight_bits);
    mean_.assign(frames_.num_frames, {});
    for (const Influence& influence : influences) {
      const double weight = influence.weight * unit;
      const std::vector<MeanMotion>& motions = motions_[influence.bone];
      for (std::size_t f = 0; f < mean_.size(); ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t k = 0; k < 3; ++k) {
            mean_[f].turn[k][c] += weight * motions[f].turn[k][c];
          }
          mean_[f].shift[c] += weight * motions[f].shift[c];
        }
      }
    }
  }

  // The rest position that suits the decoded bones best.
  Point fit_rest(std::uint32_t v) {
    find_mean_motion(v);
    std::array<std::array<double, 4>, 3> m{};
    for (std::uint32_t f = 0; f < frames_.num_frames; ++f) {
      const MeanMotion& motion = mean_[f];
      const double* x = frames_.at(f, v);
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t k = 0; k < 3; ++k) m[i][k] += motion.turn[i][c] * motion.turn[k][c];
          m[i][3] += motion.turn[i][c] * (x[c] - motion.shift[c]);
        }
      }
    }
    Point rest = rig_.rest[v];
    solve3(m, rest);
    return rest;
  }

  void code_rest() {
    BoneGof& gof = found_.gof;
    const double rest_step =
        step_ / std::sqrt(static_cast<double>(frames_.num_frames)) * kPointScale;
    gof.rest_step = static_cast<std::uint32_t>(
        std::clamp<std::int64_t>(round_to_int(rest_step), 1, kMaxRestStep));
    const std::uint32_t n = frames_.num_vertices;
    std::vector<std::int32_t> values(kRestFactors * std::size_t{n});
    gof.vertex_residual.emplace_back(values.size());
    const ValuePrediction prediction(mesh_, true, nullptr);
    std::array<std::int64_t, kRestFactors> predicted{};
    for (const std::uint32_t v : mesh_.order()) {
      prediction.predict(v, values, predicted);
      const int layer_step = gof.layer_step[mesh_.layer_of(v)];
      const double unit = static_cast<double>(gof.rest_step) * layer_step / kMaxLayerStep;
      const Point rest = fit_rest(v);
      for (std::size_t c = 0; c < 3; ++c) {
        constexpr auto kMost = static_cast<double>(kMaxResidual);
        const double steps = (rest[c] * kPointScale - static_cast<double>(predicted[c])) / unit;
        const auto residual =
            static_cast<std::int32_t>(round_to_int(std::clamp(steps, -kMost, kMost)));
        gof.vertex_residual[0][v * kRestFactors + c] = residual;
        values[v * kRestFactors + c] =
            clip_signed(rest_bits(position_bits_),
                        predicted[c] + rest_difference(gof, residual, layer_step));
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      found_.rest[c].resize(n);
      for (std::uint32_t v = 0; v < n; ++v) found_.rest[c][v] = values[v * kRestFactors + c];
    }
  }

  // What bones and rest positions leave.
  TrajectoryMatrix displacement() {
    TrajectoryMatrix matrix;
    const std::size_t num_frames = frames_.num_frames;
    matrix.num_values = frames_.num_vertices;
    matrix.num_frames = 3 * num_frames;
    matrix.a.resize(matrix.num_values * matrix.num_frames);
    for (std::uint32_t v = 0; v < frames_.num_vertices; ++v) {
      double* row = matrix.row(v);
      find_mean_motion(v);
      for (std::uint32_t f = 0; f < num_frames; ++f) {
        const MeanMotion& motion = mean_[f];
        const double* x = frames_.at(f, v);
        for (std::size_t c = 0; c < 3; ++c) {
          double left = x[c] - motion.shift[c];
          for (std::size_t k = 0; k < 3; ++k) {
            left -= motion.turn[k][c] * found_.rest[k][v] / kPointScale;
          }
          row[c * num_frames + f] = left;
        }
      }
    }
    return matrix;
  }

  const CodedMesh& mesh_;
  int position_bits_;
  const GofFrames& frames_;
  const Rig& rig_;
  const BoneSettings& settings_;
  double step_;
  BoneAnalysis found_;
  std::vector<std::vector<MeanMotion>> motions_;  // [bone][frame]
  std::vector<MeanMotion> mean_;                  // [frame], of the vertex at hand
};

// Trajectories and their spatial factors.
class TrajectoryCoder {
 public:
  TrajectoryCoder(const CodedMesh& mesh, const BoneAnalysis& analysis,
                  const BoneSettings& settings, double step)
      : mesh_(mesh),
        analysis_(analysis),
        settings_(settings),
        step_(step),
        num_frames_(analysis.gof.num_frames),
        gof_(analysis.gof) {}

  BoneGof code() {
    const double least = least_energy(step_, mesh_.num_vertices(), analysis_.gof.num_frames);
    while (count_ < analysis_.pc.temporal.size() && analysis_.pc.energy[count_] > least) {
      ++count_;
    }
    if (count_ == 0) return std::move(gof_);
    code_temporal();
    fit_spatial();
    code_spatial();
    scale();
    cut_slices();
    return std::move(gof_);
  }

 private:
  // Temporal values, each vector with the step at which its error is as large as the others'.
  void code_temporal() {
    TrackState state(gof_.num_frames);
    gof_.trajectories.resize(count_);
    decoded_.assign(count_, std::vector<double>(3 * num_frames_));
    eighths_.resize(count_);
    std::vector<std::array<double, 3>> values(num_frames_);
    for (std::size_t l = 0; l < count_; ++l) {
      // The product of both steps is 2^(eighths / 8), of which the stream keeps the exponent.
      const double wanted = step_ * std::sqrt(settings_.temporal_error / importance(l)) * step_;
      eighths_[l] = static_cast<int>(round_to_int(8.0 * det_log2(wanted)));
      const double unit = power_of_eighths(eighths_[l]) / step_;
      for (std::size_t f = 0; f < num_frames_; ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
          values[f][c] = analysis_.pc.temporal[l][c * num_frames_ + f];
        }
      }
      Trajectory& trajectory = gof_.trajectories[l];
      code_trajectory(values, unit, settings_.temporal_weights, state, trajectory);
      indices_.push_back(recon_trajectory(trajectory));
      for (std::size_t f = 0; f < num_frames_; ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
          decoded_[l][c * num_frames_ + f] = unit * indices_[l][f][c];
        }
      }
    }
  }

  // How much an error of a temporal value weighs: its sum of squared spatial factors, or as in
  // Vasa and Skala 2009, (18) and (19), the square of their summed magnitudes.
  double importance(std::size_t l) const {
    if (!settings_.cobra_steps) return analysis_.pc.energy[l];
    double sum = 0.0;
    const std::size_t width = analysis_.pc.temporal.size();
    for (std::size_t v = 0; v < mesh_.num_vertices(); ++v) {
      sum += std::abs(analysis_.spatial[v * width + l]);
    }
    return std::max(sum * sum / mesh_.num_vertices(), 1e-12);
  }

  static double power_of_eighths(int eighths) {
    const int whole = eighths >= 0 ? eighths / 8 : -((7 - eighths) / 8);
    const auto part = static_cast<std::size_t>(eighths - 8 * whole);
    return static_cast<double>(kScaleMantissa[part]) / 32768.0 * exact_exp2(whole);
  }

  // Spatial factors by least squares against the decoded temporal ones.
  void fit_spatial() {
    std::vector<double> g(count_ * count_);
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = 0.0;
        for (std::size_t f = 0; f < decoded_[i].size(); ++f)
          sum += decoded_[i][f] * decoded_[j][f];
        g[i * count_ + j] = sum;
      }
    }
    // Cholesky decomposition; vectors that vanished in quantisation get no factor.
    for (std::size_t j = 0; j < count_; ++j) {
      double d = g[j * count_ + j];
      for (std::size_t k = 0; k < j; ++k) d -= g[j * count_ + k] * g[j * count_ + k];
      const double root = d > 1e-9 * g[j * count_ + j] ? std::sqrt(d) : 0.0;
      g[j * count_ + j] = root;
      for (std::size_t i = j + 1; i < count_; ++i) {
        double x = g[i * count_ + j];
        for (std::size_t k = 0; k < j; ++k) x -= g[i * count_ + k] * g[j * count_ + k];
        g[i * count_ + j] = root > 0.0 ? x / root : 0.0;
      }
    }
    // The matrix is nearly pc.spatial * pc.temporal; what it lacks hardly shows in the decoded
    // temporal vectors. So the factors are pc.spatial * mixing.
    std::vector<double> mixing(count_ * count_);  // [component][factor]
    for (std::size_t l = 0; l < count_; ++l) {
      double* s = &mixing[l * count_];
      for (std::size_t k = 0; k < count_; ++k) {
        for (std::size_t f = 0; f < decoded_[k].size(); ++f) {
          s[k] += analysis_.pc.temporal[l][f] * decoded_[k][f];
        }
      }
      for (std::size_t i = 0; i < count_; ++i) {
        for (std::size_t k = 0; k < i; ++k) s[i] -= g[i * count_ + k] * s[k];
        s[i] = g[i * count_ + i] > 0.0 ? s[i] / g[i * count_ + i] : 0.0;
      }
      for (std::size_t i = count_; i-- > 0;) {
        for (std::size_t k = i + 1; k < count_; ++k) s[i] -= g[k * count_ + i] * s[k];
        s[i] = g[i * count_ + i] > 0.0 ? s[i] / g[i * count_ + i] : 0.0;
      }
    }
    spatial_ = matrix_product(analysis_.spatial, analysis_.pc.temporal.size(), mixing, count_);
  }

  // Residuals in closed loop.
  void code_spatial() {
    std::optional<GeometryWeights> weights;
    if (gof_.prediction == Prediction::kLayers) {
      const auto& rest = analysis_.rest;
      weights.emplace(mesh_, gof_,
                      std::array<std::span<const std::int32_t>, 3>{rest[0], rest[1], rest[2]});
    }
    const ValuePrediction prediction(mesh_, false, weights ? &*weights : nullptr);
    residual_.resize(spatial_.size());
    std::vector<std::int32_t> values(spatial_.size());
    std::vector<std::int64_t> predicted(count_);
    largest_.assign(count_, 0);
    const double per_step = kMaxLayerStep / step_;
    for (const std::uint32_t v : mesh_.order()) {
      prediction.predict(v, values, predicted);
      const int layer_step = gof_.layer_step[mesh_.layer_of(v)];
      for (std::size_t l = 0; l < count_; ++l) {
        const double difference =
            spatial_[v * count_ + l] * per_step - static_cast<double>(predicted[l]);
        const double steps = std::abs(difference) / layer_step + 0.5 - settings_.dead_zone;
        const auto magnitude =
            static_cast<std::int32_t>(std::min(steps, static_cast<double>(kMaxResidual)));
        const std::int32_t residual = difference < 0.0 ? -magnitude : magnitude;
        residual_[v * count_ + l] = residual;
        const std::int32_t value = clip_signed(
            kMaxSpatialBits, predicted[l] + factor_difference(residual, layer_step));
        values[v * count_ + l] = value;
        largest_[l] = std::max(largest_[l], value < 0 ? ~value : value);
      }
    }
  }

  // Slices that a stream can be cut at: as many as cost little beside what they hold.
  void cut_slices() {
    std::size_t num_groups = settings_.component_groups;
    std::size_t num_layer_groups = settings_.layer_groups;
    const double slices = estimated_bytes() / kBytesOfSlice;
    if (num_groups == 0) num_groups = slices < 4 ? 1 : slices < 12 ? 2 : slices < 24 ? 3 : 4;
    if (num_layer_groups == 0) num_layer_groups = slices < 6 ? 1 : slices < 16 ? 2 : 3;
    cut_layers(num_layer_groups);
    cut_components(num_groups);
    gof_.slice_layers.assign(gof_.group_end.size(),
                             static_cast<std::uint32_t>(gof_.layer_group_size.size()));
  }

  double estimated_bytes() const {
    constexpr double kZeroBits = 0.4;
    double bits = 0.0;
    for (const std::int32_t r : residual_) {
      bits += r == 0 ? kZeroBits
                     : 2.0 + 1.5 * floor_log2(static_cast<std::uint64_t>(r < 0 ? -r : r));
    }
    return bits / 8.0;
  }

  // Each group of layers but the last doubles the vertices thrice.
  void cut_layers(std::size_t num_groups) {
    const std::uint32_t num_layers = mesh_.num_layers();
    std::vector<std::uint32_t> ends{num_layers};
    for (std::uint32_t last = num_layers; ends.size() < num_groups; ends.push_back(last)) {
      const std::size_t most = mesh_.vertices_of_layers(0, last).size() / 8;
      while (last > 1 && mesh_.vertices_of_layers(0, last).size() > most) --last;
      if (last == ends.back()) break;
    }
    gof_.layer_group_size.clear();
    std::uint32_t first = 0;
    for (std::size_t i = ends.size(); i-- > 0;) {
      gof_.layer_group_size.push_back(ends[i] - first);
      first = ends[i];
    }
  }

  // Each group of trajectories has about three times as many as those before.
  void cut_components(std::size_t num_groups) {
    std::vector<std::size_t> ends{count_};
    while (ends.size() < num_groups && ends.back() > 1) ends.push_back(ends.back() / 3 + 1);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::size_t first = 0;
    for (std::size_t i = ends.size(); i-- > 0;) {
      const std::size_t size = ends[i] - first;
      std::vector<std::int32_t> of_group(mesh_.num_vertices() * size);
      for (std::size_t v = 0; v < mesh_.num_vertices(); ++v) {
        std::copy_n(&residual_[v * count_ + first], size, &of_group[v * size]);
      }
      gof_.vertex_residual.push_back(std::move(of_group));
      gof_.group_end.push_back(kRestFactors + ends[i]);
      first = ends[i];
    }
    gof_.num_component_groups = static_cast<std::uint32_t>(ends.size());
  }

  // Widths and scales: the sums get as many fractional bits as all temporal factors need.
  void scale() {
    std::vector<int> idx(count_);
    int fraction_bits = 0;
    for (std::size_t l = 0; l < count_; ++l) {
      Trajectory& t = gof_.trajectories[l];
      t.spatial_bits =
          largest_[l] == 0 ? 1 : floor_log2(static_cast<std::uint64_t>(largest_[l])) + 2;
      const int shift = spatial_factor_bits(t.spatial_bits) - t.spatial_bits;
      idx[l] = eighths_[l] + 8 * (4 - shift);
      fraction_bits = std::max(fraction_bits, (kWantedScaleIdx - idx[l] + 7) / 8);
    }
    const int most = *std::max_element(idx.begin(), idx.end());
    fraction_bits = std::clamp(fraction_bits, 0, kMaxFractionBits);
    while (fraction_bits > 0 && most + 8 * fraction_bits > kMaxScaleIdx) --fraction_bits;
    gof_.fraction_bits = fraction_bits;
    for (std::size_t l = 0; l < count_; ++l) {
      Trajectory& t = gof_.trajectories[l];
      t.scale_idx = std::clamp(idx[l] + 8 * fraction_bits, 0, kMaxScaleIdx);
      std::int64_t largest = 0;
      for (const Vec3i& value : indices_[l]) {
        for (const std::int32_t x : value) {
          const std::int64_t scaled = scale_temporal(x, t.scale_idx, kMaxTemporalBits);
          largest = std::max(largest, scaled < 0 ? ~scaled : scaled);
        }
      }
      t.temporal_bits = largest == 0 ? 1 : floor_log2(static_cast<std::uint64_t>(largest)) + 2;
    }
  }

  const CodedMesh& mesh_;
  const BoneAnalysis& analysis_;
  const BoneSettings& settings_;
  double step_;
  std::size_t num_frames_;
  BoneGof gof_;
  std::size_t count_ = 0;                     // trajectories
  std::vector<int> eighths_;                  // of the product of both steps
  std::vector<std::vector<Vec3i>> indices_;   // temporal values
  std::vector<std::vector<double>> decoded_;  // [count][3 * num_frames]
  std::vector<double> spatial_;               // [num_vertices][count], grid units
  std::vector<std::int32_t> residual_;        // likewise, coded
  std::vector<std::int32_t> largest_;         // magnitude of the values of each factor
};

}  // namespace

BoneAnalysis analyse_bones(const CodedMesh& mesh, int position_bits, const GofFrames& frames,
                           std::uint32_t first_frame, const Rig& rig,
                           const BoneSettings& settings, double step) {
  return BoneAnalyser(mesh, position_bits, frames, rig, settings, step).analyse(first_frame);
}

BoneGof code_bone_gof(const CodedMesh& mesh, int /*position_bits*/,
                      const BoneAnalysis& analysis, const BoneSettings& settings, double step) {
  return TrajectoryCoder(mesh, analysis, settings, step).code();
}

}  // namespace rlpc
