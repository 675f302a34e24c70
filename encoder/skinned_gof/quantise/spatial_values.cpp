#include "encoder/skinned_gof/quantise/spatial_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "common/int_math.h"
#include "common/skinned_gof/recon/skinned_recon.h"
#include "encoder/gof/residual_choice.h"
#include "encoder/math/matrix_products.h"
#include "encoder/math/symmetric_system.h"

namespace rlpc {
namespace {

// Wanted values up to this limit fit their width, however they are rounded.
constexpr double kMostSpatial =
    (1 << (kMaxSpatialBits - 1)) - 2.0 * kMaxLayerStep;  // fixed: format

// Spatial factors in grid units: the least-squares fit to the decoded temporal vectors. The
// matrix is approximated by pc.spatial * pc.temporal, since the dropped components are almost
// orthogonal to the decoded vectors. So the factors are pc.spatial * mixing.
class FittedFactors {
 public:
  FittedFactors(const ComponentsByRow& pc, const TemporalValues& temporal)
      : pc_(pc),
        count_(temporal.size()),
        num_tried_(temporal.num_tried),
        mixing_(find_mixing(temporal)) {}

  // [vertex][trajectory]
  std::vector<double> of(std::span<const std::uint32_t> vertices) const {
    std::vector<double> components;
    components.reserve(vertices.size() * num_tried_);
    for (const std::uint32_t v : vertices) {
      const auto from =
          pc_.spatial.begin() + static_cast<std::ptrdiff_t>(v * pc_.temporal.size());
      components.insert(components.end(), from, from + static_cast<std::ptrdiff_t>(num_tried_));
    }
    return matrix_product(components, num_tried_, mixing_, count_);
  }

 private:
  // [component][trajectory]. Temporal vectors quantised to zero get no factor.
  std::vector<double> find_mixing(const TemporalValues& temporal) const {
    constexpr double kVanished = 1e-9;  // fixed: rounding
    const std::size_t width = temporal.decoded.front().size();
    const auto products = [&](std::span<const std::vector<double>> vectors) {
      const std::vector<double> columns = as_columns(vectors, width);
      std::vector<double> rows;  // [trajectory][vector]
      for (const auto& vector : temporal.decoded) {
        const std::vector<double> row = ordered_product(vector, columns, vectors.size());
        rows.insert(rows.end(), row.begin(), row.end());
      }
      return rows;
    };
    const SymmetricSystem gram(products(temporal.decoded), count_, kVanished);
    std::vector<double> mixing = products(std::span(pc_.temporal).first(num_tried_));
    gram.solve(mixing, num_tried_);
    std::vector<double> transposed(mixing.size());
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t k = 0; k < num_tried_; ++k) {
        transposed[k * count_ + i] = mixing[i * num_tried_ + k];
      }
    }
    return transposed;
  }

  const ComponentsByRow& pc_;
  std::size_t count_;
  std::size_t num_tried_;
  std::vector<double> mixing_;
};

// The adaptive weights before the first trajectory; none if there are none.
std::optional<AdaptiveWeights> start_weights(const CodedMesh& mesh, const SkinnedModel& model,
                                             const SkinnedAnalysis& analysis,
                                             const std::optional<GeometryWeights>& weights,
                                             const ModelRecon* shared) {
  if (shared != nullptr) {
    const AdaptiveWeights* before = shared->adaptive_weights();
    return before != nullptr ? std::optional(*before) : std::nullopt;
  }
  if (model.weights.num_adaptive_factors == 0) return std::nullopt;
  const auto& rest = analysis.rest;
  return AdaptiveWeights(
      mesh, *weights, model.weights,
      std::array<std::span<const std::int32_t>, 3>{rest[0], rest[1], rest[2]});
}

// Rounds the residuals of vertices, trajectory by trajectory, as the settings require.
class ResidualRounding {
 public:
  ResidualRounding(const CodedMesh& mesh, std::size_t count, Rounding rounding)
      : round_up_(rounding == Rounding::kNearest ? 0.5 : 0.5 - kDeadZone) {
    if (rounding == Rounding::kCheapest) choice_.emplace(mesh, count);
  }
  void start(std::uint32_t v) {
    if (choice_) choice_->start(v);
  }
  // The residual of the next trajectory; wanted: in steps.
  std::int32_t next(double wanted) {
    return choice_ ? choice_->next(wanted) : rounded_residual(wanted, round_up_);
  }

 private:
  double round_up_;
  std::optional<VertexResidualChoice> choice_;
};

}  // namespace

SpatialValues code_spatial_values(const CodedMesh& mesh, const SkinnedModel& model,
                                  const SkinnedAnalysis& analysis,
                                  const TemporalValues& temporal,
                                  std::span<const std::size_t> group_end,
                                  const ModelRecon* shared, Rounding rounding, double step) {
  constexpr std::size_t kTogether = 16;  // fixed: vertices whose factors are found at a time
  const std::size_t count = temporal.size();
  std::optional<GeometryWeights> weights;
  if (model.prediction == Prediction::kLayers) {
    const auto& rest = analysis.rest;
    weights.emplace(mesh, model.weights,
                    std::array<std::span<const std::int32_t>, 3>{rest[0], rest[1], rest[2]});
  }
  const ValuePrediction prediction(mesh, false, weights ? &*weights : nullptr);
  std::optional<AdaptiveWeights> adaptive =
      start_weights(mesh, model, analysis, weights, shared);
  std::optional<VertexAdaptation> adaptation;
  if (adaptive) {
    const std::size_t before = shared != nullptr ? shared->factors()->num_components() : 0;
    adaptive->start(before, count, group_end);
    adaptation.emplace(*adaptive);
  }
  const FittedFactors all_factors(analysis.pc, temporal);
  ResidualRounding residuals(mesh, count, rounding);
  SpatialValues result;
  result.residual.resize(mesh.num_vertices() * count);
  result.largest.assign(count, 0);
  std::vector<std::int32_t> values(result.residual.size());
  std::vector<double> factors;
  std::vector<std::int64_t> predicted(count);
  double most = 0.0;
  const double per_step = kMaxLayerStep / step;
  const std::span<const std::uint32_t> order = mesh.order();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t v = order[i];
    const bool adapts = adaptation && adaptation->start(v, values);
    if (!adapts) prediction.predict(v, values, predicted);
    const std::size_t place = i % kTogether;
    if (place == 0) {
      factors = all_factors.of(order.subspan(i, std::min(kTogether, order.size() - i)));
    }
    const int layer_step = model.layer_step[mesh.layer_of(v)];
    residuals.start(v);
    for (std::size_t l = 0; l < count; ++l) {
      const double wanted = factors[place * count + l] * per_step;
      most = std::max(most, std::abs(wanted));
      if (adapts) predicted[l] = adaptation->predict();
      const std::int32_t residual =
          residuals.next((wanted - static_cast<double>(predicted[l])) / layer_step);
      result.residual[v * count + l] = residual;
      const std::int32_t value =
          clip_signed(kMaxSpatialBits, predicted[l] + factor_difference(residual, layer_step));
      if (adapts) adaptation->add(predicted[l], value);
      values[v * count + l] = value;
      result.largest[l] = std::max(result.largest[l], value < 0 ? ~value : value);
    }
  }
  result.excess = most / kMostSpatial;
  return result;
}

}  // namespace rlpc
