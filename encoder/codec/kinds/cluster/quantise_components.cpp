#include "encoder/codec/kinds/cluster/quantise_components.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "common/codec/bits/int_math.h"
#include "common/codec/bits/residual_models.h"
#include "common/codec/components/series_predictor.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

// Returns the narrowest two's complement width, in bits, that holds every value.
int signed_width(const std::vector<std::int32_t>& values) {
  int bits = 1;
  for (const std::int32_t v : values) {
    const auto magnitude = static_cast<std::uint64_t>(v < 0 ? -(v + 1) : v);
    if (magnitude > 0) bits = std::max(bits, floor_log2(magnitude) + 2);
    if (v > 0) bits = std::max(bits, 2);
  }
  return bits;
}

std::vector<std::int32_t> temporal_residuals(const std::vector<std::int32_t>& values,
                                             int order) {
  std::vector<std::int32_t> residuals(values.size());
  const auto series = [&](std::uint32_t g) { return std::int64_t{values[g]}; };
  for (std::uint32_t f = 0; f < values.size(); ++f) {
    residuals[f] = static_cast<std::int32_t>(values[f] - predict_series(series, f, order));
  }
  return residuals;
}

std::vector<std::int32_t> spatial_residuals(const std::vector<std::int32_t>& values,
                                            SpatialPredictor predictor,
                                            const SpatialPrediction& prediction) {
  std::vector<std::int32_t> residuals(values.size());
  const std::size_t n = values.size() / 3;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::span<const std::int32_t> plane(values.data() + c * n, n);
    for (std::size_t i = 0; i < n; ++i) {
      residuals[c * n + i] =
          static_cast<std::int32_t>(plane[i] - prediction.predict(predictor, plane, i));
    }
  }
  return residuals;
}

// Returns floor(eighths / 8).
int floor_octave(int eighths) { return (eighths + 8000) / 8 - 1000; }

// Returns the exponent of a spatial factor's normalisation (8.5.2).
int norm_shift(const QuantisedComponent& c) {
  const int bits = signed_width(c.spatial);
  return spatial_factor_bits(bits) - bits;
}

}  // namespace

StepPair make_steps(double spatial_step, double temporal_step) {
  constexpr double kLocalUnit = 1 << kLocalFractionBits;  // fixed: format
  StepPair steps{spatial_step, temporal_step, 0};
  const double eighths = 8.0 * det_log2(spatial_step * temporal_step * kLocalUnit);
  steps.product_eighths = static_cast<int>(round_to_int(eighths));
  const int octave = floor_octave(steps.product_eighths);
  const auto index = static_cast<std::size_t>(steps.product_eighths - 8 * octave);
  constexpr double kMantissaUnit = 32768.0;  // fixed: format
  const double product = kScaleMantissa[index] / kMantissaUnit * exact_exp2(octave);
  steps.spatial = product / (kLocalUnit * temporal_step);
  return steps;
}

std::vector<std::int32_t> quantise(const std::vector<double>& values, double step,
                                   double dead_zone) {
  std::vector<std::int32_t> q(values.size());
  const double inverse = 1.0 / step;
  const double offset = 0.5 - dead_zone;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = values[i] * inverse;
    q[i] = static_cast<std::int32_t>(x < 0.0 ? x - offset : x + offset);
  }
  return q;
}

double estimate_bits(const std::vector<std::int32_t>& residuals) {
  constexpr double kZeroBits = 0.02;  // fixed: bits of a value if all are zero
  if (residuals.empty()) return 0.0;
  std::uint64_t sum = 0;
  for (const std::int32_t r : residuals) sum += magnitude_of(r);
  const auto count = static_cast<double>(residuals.size());
  const double mean = static_cast<double>(sum) / count;
  if (sum == 0) return kZeroBits * count;
  // P(0) = (1 - r) / (1 + r), P(+-k) = P(0) r^k with mean magnitude 2 r / (1 - r^2).
  const double r = (std::sqrt(1.0 + mean * mean) - 1.0) / mean;
  const double p0 = (1.0 - r) / (1.0 + r);
  return count * (-det_log2(p0) - mean * det_log2(r));
}

void choose_predictors(QuantisedComponent& component, const SpatialPrediction& prediction) {
  double best_temporal = std::numeric_limits<double>::infinity();
  for (int order = 0; order <= kMaxPredictorOrder; ++order) {
    const double bits = estimate_bits(temporal_residuals(component.temporal, order));
    if (bits >= best_temporal) continue;
    best_temporal = bits;
    component.temporal_predictor = order;
  }
  double best_spatial = std::numeric_limits<double>::infinity();
  for (const auto predictor : {SpatialPredictor::kNone, SpatialPredictor::kNeighbours,
                               SpatialPredictor::kParallelogram}) {
    const double bits =
        estimate_bits(spatial_residuals(component.spatial, predictor, prediction));
    if (bits >= best_spatial) continue;
    best_spatial = bits;
    component.spatial_predictor = predictor;
  }
  constexpr double kHeaderBits = 8.0;  // fixed: bits of a component
  component.bits = best_temporal + best_spatial + kHeaderBits;
}

int choose_fraction_bits(const std::vector<std::vector<QuantisedComponent>>& clusters) {
  // A temporal step should span at least 4 units of the factor, so that rounding the factor
  // adds little to the error; but the factor must fit its width.
  constexpr int kTemporalUnitEighths = 16;  // fixed: two octaves
  int wanted = 0;
  int allowed = kMaxFractionBits;
  for (const auto& components : clusters) {
    for (const QuantisedComponent& c : components) {
      const int eighths = c.steps.product_eighths - 8 * norm_shift(c);
      const int octaves =
          floor_octave(eighths) + 1;  // the scale without fraction bits is below 2^octaves
      wanted = std::max(wanted, -floor_octave(eighths - kTemporalUnitEighths));
      allowed = std::min(allowed, kMaxTemporalBits - signed_width(c.temporal) - octaves);
    }
  }
  return std::clamp(wanted, 0, std::max(allowed, 0));
}

Component make_component(const QuantisedComponent& c, const SpatialPrediction& prediction,
                         int fraction_bits) {
  constexpr int kUnitScaleIdx = 32;  // fixed: scale 1, as 8.5.2 shifts by 19 - scale_idx / 8
  Component component;
  component.scale_idx =
      std::clamp(c.steps.product_eighths + 8 * (fraction_bits - norm_shift(c)) + kUnitScaleIdx,
                 0, kMaxScaleIdx);
  component.spatial_bits = signed_width(c.spatial);
  assert(component.spatial_bits <= kMaxSpatialBits);
  std::vector<std::int32_t> factors = c.temporal;
  for (std::int32_t& t : factors) t = scale_temporal(t, component.scale_idx, kMaxTemporalBits);
  component.temporal_bits = signed_width(factors);
  component.temporal_predictor = c.temporal_predictor;
  component.spatial_predictor = c.spatial_predictor;
  component.temporal_residual = temporal_residuals(c.temporal, c.temporal_predictor);
  component.spatial_residual = spatial_residuals(c.spatial, c.spatial_predictor, prediction);
  return component;
}

}  // namespace rlpc
