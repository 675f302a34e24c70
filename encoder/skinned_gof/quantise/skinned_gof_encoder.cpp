#include "encoder/skinned_gof/quantise/skinned_gof_encoder.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "common/cluster_gof/cluster_gof.h"
#include "common/int_math.h"
#include "common/skinned_gof/recon/skinned_recon.h"
#include "common/syntax/sequence_header.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/gof/residual_choice.h"
#include "encoder/math/det_math.h"
#include "encoder/math/matrix_products.h"
#include "encoder/skinned_gof/quantise/track_coding.h"

namespace rlpc {
namespace {

// A slice is worth having if it holds about this much.
constexpr double kBytesOfSlice = 4000.0;
// Temporal values are scaled so that their step is 2^3 units of the sums, if that can be.
constexpr int kWantedScaleIdx = 56;

// Squared error of a temporal value, relative to that of a spatial one; and what a vertex costs
// at least for a trajectory, in squared steps. What bones leave is in few places, where
// neighbours tell little about it.
constexpr double kTemporalError = 0.8;
constexpr double kTemporalErrorOfBones = 2.0;
constexpr double kSpatialCost = 0.02;
constexpr double kSpatialCostOfBones = 0.06;

// Products of steps, in eighths of an octave, have a scale_idx up to this one.
constexpr int kMostEighths = kMaxScaleIdx - 8 * 4;
// Wanted values up to these fit their widths, whatever they are rounded to.
constexpr double kMostTemporal = 1 << (kTemporalIndexBits - 2);
constexpr double kMostSpatial = (1 << (kMaxSpatialBits - 1)) - 2.0 * kMaxLayerStep;

// Trajectories and their spatial factors.
class TrajectoryCoder {
 public:
  TrajectoryCoder(const CodedMesh& mesh, const SkinnedAnalysis& analysis,
                  const SkinnedSettings& settings, double step)
      : mesh_(mesh),
        analysis_(analysis),
        settings_(settings),
        step_(step),
        num_frames_(analysis.gof.num_frames),
        gof_(analysis.gof) {
    gof_.weights = {settings.damping_log2, settings.outer_weight, settings.outer_scale};
  }

  bool has(std::size_t count) {
    code_temporal(count);
    return count_ == count;
  }
  SkinnedGof code() {
    while (!code_trajectories()) {
    }
    cut_slices();
    return std::move(gof_);
  }

 private:
  // False: some values do not fit their widths, and steps have become coarser for the next try.
  bool code_trajectories() {
    code_temporal();
    if (count_ == 0) return true;
    find_mixing();
    code_spatial();
    constexpr double kReserve = 1.02;
    if (excess_ > 1.0) {
      step_ *= kReserve * excess_;
      return false;
    }
    return scale();
  }

  // Temporal values of the trajectories that are worth their bits, or the first of them.
  void code_temporal(std::size_t most = kLevels.back().max_components) {
    constexpr int kMostInVain = 4;  // of the next ones, none will do better
    TrackState state(gof_.num_frames);
    gof_.trajectories.clear();
    decoded_.clear();
    eighths_.clear();
    indices_.clear();
    const std::vector<double>& energy = analysis_.pc.energy;
    const double least = least_energy(step_, analysis_.gof, mesh_.num_vertices());
    int in_vain = 0;
    for (num_tried_ = 0; num_tried_ < analysis_.pc.temporal.size(); ++num_tried_) {
      const bool enough = gof_.trajectories.size() == most || in_vain == kMostInVain;
      if (enough || energy[num_tried_] <= least) break;
      in_vain = code_temporal(num_tried_, state) ? 0 : in_vain + 1;
    }
    count_ = gof_.trajectories.size();
  }

  // Those of one, with the step at which its error is as large as the others'. False: it is not
  // worth its bits.
  bool code_temporal(std::size_t l, TrackState& state) {
    // The product of both steps is 2^(eighths / 8), of which the stream keeps the exponent.
    const std::vector<double>& temporal = analysis_.pc.temporal[l];
    const double wanted = step_ * std::sqrt(temporal_error() / importance(l)) * step_;
    const double least = step_ * largest(temporal) / kMostTemporal;
    const int eighths =
        std::clamp(static_cast<int>(round_to_int(8.0 * det_log2(std::max(wanted, least)))),
                   least_eighths_, kMostEighths);
    const double unit = power_of_eighths(eighths) / step_;
    std::vector<std::array<double, 3>> values(num_frames_);
    for (std::size_t f = 0; f < num_frames_; ++f) {
      for (std::size_t c = 0; c < 3; ++c) values[f][c] = temporal[c * num_frames_ + f];
    }
    Trajectory trajectory;
    TrackState after = state;
    const TrackCost cost =
        code_trajectory(values, unit,
                        {.refine = settings_.temporal_weights,
                         .nearest = settings_.rounding == Rounding::kNearest},
                        after, trajectory);
    const double saved = analysis_.pc.energy[l] * (1.0 - cost.error * unit * unit);
    if (saved < least_worth(cost.bits)) return false;
    state = std::move(after);
    eighths_.push_back(eighths);
    indices_.push_back(recon_trajectory(trajectory));
    gof_.trajectories.push_back(std::move(trajectory));
    std::vector<double>& decoded = decoded_.emplace_back(3 * num_frames_);
    for (std::size_t f = 0; f < num_frames_; ++f) {
      for (std::size_t c = 0; c < 3; ++c) {
        decoded[c * num_frames_ + f] = unit * indices_.back()[f][c];
      }
    }
    return true;
  }

  // The energy that a trajectory must save: what its temporal values cost, and its spatial
  // factors cost and leave.
  double least_worth(double bits) const {
    const double of_vertex = has_bones() ? kSpatialCostOfBones : kSpatialCost;
    return step_ * step_ * (kErrorPerBit * bits + of_vertex * mesh_.num_vertices());
  }

  bool has_bones() const { return analysis_.gof.bones.size() > 1; }

  double temporal_error() const { return has_bones() ? kTemporalErrorOfBones : kTemporalError; }

  // How much an error of a temporal value weighs: its sum of squared spatial factors, or as in
  // Vasa and Skala 2009, (18) and (19), the square of their summed magnitudes.
  double importance(std::size_t l) const {
    if (!settings_.cobra_steps) return analysis_.pc.energy[l];
    double sum = 0.0;
    const std::size_t width = analysis_.pc.temporal.size();
    for (std::size_t v = 0; v < mesh_.num_vertices(); ++v) {
      sum += std::abs(double{analysis_.pc.spatial[v * width + l]});
    }
    return std::max(sum * sum / mesh_.num_vertices(), 1e-12);
  }

  static double power_of_eighths(int eighths) {
    const int whole = eighths >= 0 ? eighths / 8 : -((7 - eighths) / 8);
    const auto part = static_cast<std::size_t>(eighths - 8 * whole);
    return static_cast<double>(kScaleMantissa[part]) / 32768.0 * exact_exp2(whole);
  }

  // What spatial factors are made with from those of the components: least squares against the
  // decoded temporal vectors. The matrix is nearly pc.spatial * pc.temporal; what it lacks
  // hardly shows in those. So the factors are pc.spatial * mixing.
  void find_mixing() {
    const std::size_t width = 3 * num_frames_;
    const std::vector<double> decoded = as_columns(decoded_, width);
    std::vector<double> g;
    for (const auto& vector : decoded_) {
      const std::vector<double> row = ordered_product(vector, decoded, count_);
      g.insert(g.end(), row.begin(), row.end());
    }
    decompose(g);
    const auto tried = std::span(analysis_.pc.temporal).first(num_tried_);
    const std::vector<double> temporal = as_columns(tried, width);
    std::vector<std::vector<double>> mixing;  // [factor][component]
    for (const auto& vector : decoded_) {
      mixing.push_back(ordered_product(vector, temporal, num_tried_));
    }
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        subtract_multiple(g[i * count_ + k], mixing[k], mixing[i]);
      }
      divide(mixing[i], g[i * count_ + i]);
    }
    for (std::size_t i = count_; i-- > 0;) {
      for (std::size_t k = i + 1; k < count_; ++k) {
        subtract_multiple(g[k * count_ + i], mixing[k], mixing[i]);
      }
      divide(mixing[i], g[i * count_ + i]);
    }
    mixing_ = as_columns(mixing, num_tried_);
  }

  // Cholesky decomposition of a matrix, [count][count], in place; only the lower triangle
  // counts. Vectors that vanished in quantisation get no factor: a root of 0.
  void decompose(std::vector<double>& g) const {
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
  }

  // 0 where there is no factor.
  static void divide(std::vector<double>& values, double root) {
    for (double& x : values) x = root > 0.0 ? x / root : 0.0;
  }

  // Spatial factors of some vertices, grid units.
  std::vector<double> fit_spatial(std::span<const std::uint32_t> vertices) {
    of_vertices_.clear();
    for (const std::uint32_t v : vertices) {
      const auto from = analysis_.pc.spatial.begin() +
                        static_cast<std::ptrdiff_t>(v * analysis_.pc.temporal.size());
      of_vertices_.insert(of_vertices_.end(), from,
                          from + static_cast<std::ptrdiff_t>(num_tried_));
    }
    return matrix_product(of_vertices_, num_tried_, mixing_, count_);
  }

  // Residuals in closed loop.
  void code_spatial() {
    std::optional<GeometryWeights> weights;
    if (gof_.prediction == Prediction::kLayers) {
      const auto& rest = analysis_.rest;
      weights.emplace(mesh_, gof_.weights,
                      std::array<std::span<const std::int32_t>, 3>{rest[0], rest[1], rest[2]});
    }
    const ValuePrediction prediction(mesh_, false, weights ? &*weights : nullptr);
    residual_.resize(mesh_.num_vertices() * count_);
    std::vector<std::int32_t> values(residual_.size());
    constexpr std::size_t kTogether = 16;
    std::vector<double> factors;  // of so many vertices
    std::vector<std::int64_t> predicted(count_);
    largest_.assign(count_, 0);
    double most = 0.0;
    const double per_step = kMaxLayerStep / step_;
    std::optional<VertexResidualChoice> choice;
    if (settings_.rounding == Rounding::kCheapest) choice.emplace(mesh_, count_);
    constexpr double kRoundUpOfDeadZone = 0.42;
    const double round_up = settings_.rounding == Rounding::kNearest ? 0.5 : kRoundUpOfDeadZone;
    const std::span<const std::uint32_t> order = mesh_.order();
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::uint32_t v = order[i];
      prediction.predict(v, values, predicted);
      const std::size_t place = i % kTogether;
      if (place == 0) {
        factors = fit_spatial(order.subspan(i, std::min(kTogether, order.size() - i)));
      }
      const int layer_step = gof_.layer_step[mesh_.layer_of(v)];
      if (choice) choice->start(v);
      for (std::size_t l = 0; l < count_; ++l) {
        const double wanted = factors[place * count_ + l] * per_step;
        most = std::max(most, std::abs(wanted));
        const double difference = wanted - static_cast<double>(predicted[l]);
        const std::int32_t residual = choice
                                          ? choice->next(difference / layer_step)
                                          : rounded_residual(difference / layer_step, round_up);
        residual_[v * count_ + l] = residual;
        const std::int32_t value = clip_signed(
            kMaxSpatialBits, predicted[l] + factor_difference(residual, layer_step));
        values[v * count_ + l] = value;
        largest_[l] = std::max(largest_[l], value < 0 ? ~value : value);
      }
    }
    excess_ = most / kMostSpatial;
  }

  // Slices that a stream can be cut at: as many as cost little beside what they hold.
  void cut_slices() {
    std::size_t num_groups = settings_.component_groups;
    std::size_t num_layer_groups = settings_.layer_groups;
    const double slices = estimated_bytes() / kBytesOfSlice;
    if (num_groups == 0) num_groups = slices < 4 ? 1 : slices < 12 ? 2 : slices < 24 ? 3 : 4;
    if (num_layer_groups == 0) num_layer_groups = slices < 6 ? 1 : slices < 16 ? 2 : 3;
    cut_layers(num_layer_groups);
    if (count_ > 0) cut_components(num_groups);
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

  // Each group of layers but the last ends where an eighth of the vertices of the next is left,
  // or sooner, if else there were not as many groups as are asked for.
  void cut_layers(std::size_t num_groups) {
    const std::uint32_t num_layers = mesh_.num_layers();
    const std::uint32_t asked = std::min(settings_.layer_groups, num_layers);
    std::vector<std::uint32_t> ends{num_layers};
    for (std::uint32_t last = num_layers; ends.size() < num_groups; ends.push_back(last)) {
      const std::size_t most = mesh_.vertices_of_layers(0, last).size() / 8;
      const auto num_ends = static_cast<std::uint32_t>(ends.size());
      const std::uint32_t first = std::max(asked, num_ends + 1) - num_ends;
      while (last > first && mesh_.vertices_of_layers(0, last).size() > most) --last;
      if (last == ends.back()) break;
    }
    gof_.layer_group_size.clear();
    std::uint32_t first = 0;
    for (std::size_t i = ends.size(); i-- > 0;) {
      gof_.layer_group_size.push_back(ends[i] - first);
      first = ends[i];
    }
  }

  // Each group of trajectories has about three times as many as those before, or fewer, if else
  // there were not as many groups as are asked for.
  void cut_components(std::size_t num_groups) {
    const std::size_t asked = std::min<std::size_t>(settings_.component_groups, count_);
    std::vector<std::size_t> ends{count_};
    while (ends.size() < num_groups && ends.back() > 1) {
      const std::size_t least = std::max(asked, ends.size() + 1) - ends.size();
      ends.push_back(std::max(ends.back() / 3 + 1, least));
    }
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

  // Widths and scales: the sums get as many fractional bits as all temporal factors need. False
  // where scales are too far apart; then the finest temporal steps have become coarser.
  bool scale() {
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
    const int lacking = -(*std::min_element(idx.begin(), idx.end()) + 8 * fraction_bits);
    if (lacking > 0) {
      least_eighths_ = *std::min_element(eighths_.begin(), eighths_.end()) + lacking;
      return false;
    }
    while (!set_temporal_widths(idx, fraction_bits)) --fraction_bits;
    gof_.fraction_bits = fraction_bits;
    return true;
  }

  // False: some are beyond the widest, and sums should have fewer fractional bits.
  bool set_temporal_widths(const std::vector<int>& idx, int fraction_bits) {
    for (std::size_t l = 0; l < count_; ++l) {
      Trajectory& t = gof_.trajectories[l];
      t.scale_idx = idx[l] + 8 * fraction_bits;
      std::int64_t largest = 0;
      for (const Vec3i& value : indices_[l]) {
        for (const std::int32_t x : value) {
          const std::int64_t scaled = scale_temporal(x, t.scale_idx, kMaxTemporalBits + 1);
          largest = std::max(largest, scaled < 0 ? ~scaled : scaled);
        }
      }
      t.temporal_bits = largest == 0 ? 1 : floor_log2(static_cast<std::uint64_t>(largest)) + 2;
      if (t.temporal_bits > kMaxTemporalBits) return false;
    }
    return true;
  }

  static double largest(const std::vector<double>& values) {
    double most = 0.0;
    for (const double x : values) most = std::max(most, std::abs(x));
    return most;
  }

  const CodedMesh& mesh_;
  const SkinnedAnalysis& analysis_;
  const SkinnedSettings& settings_;
  double step_;
  int least_eighths_ = -1000;  // of eighths_: none so far
  double excess_ = 0.0;        // largest spatial value, of those that fit
  std::size_t num_frames_;
  SkinnedGof gof_;
  std::size_t num_tried_ = 0;                 // trajectories: the first components,
  std::size_t count_ = 0;                     // of which so many are coded
  std::vector<int> eighths_;                  // of the product of both steps
  std::vector<std::vector<Vec3i>> indices_;   // temporal values
  std::vector<std::vector<double>> decoded_;  // [count][3 * num_frames]
  std::vector<double> mixing_;                // [num_tried][count]
  std::vector<double> of_vertices_;           // spatial values of the components
  std::vector<std::int32_t> residual_;        // [num_vertices][count], coded
  std::vector<std::int32_t> largest_;         // magnitude of the values of each factor
};

}  // namespace

bool has_trajectories(std::size_t count, const CodedMesh& mesh, const SkinnedAnalysis& analysis,
                      const SkinnedSettings& settings, double step) {
  return TrajectoryCoder(mesh, analysis, settings, step).has(count);
}

double expected_squared_error(const SkinnedAnalysis& analysis, double step) {
  constexpr double kOfCoded = 0.52;  // of what uniform quantisation adds to each value
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
  return TrajectoryCoder(mesh, analysis, settings, step).code();
}

}  // namespace rlpc
