#include "common/codec/mesh_prediction/rest_recon.h"

#include <array>
#include <cstdint>

#include "common/codec/bits/fixed_point.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

// Largest difference of two rest positions along any axis.
constexpr std::int64_t kMaxDifference = std::int64_t{1} << 30;

}  // namespace

RestRecon::RestRecon(const RestOrder& order, const RestSettings& settings,
                     std::uint32_t rest_step, int position_bits)
    : order_(order),
      settings_(settings),
      rest_step_(rest_step),
      bits_(rest_bits(position_bits)),
      values_(kRestFactors * std::size_t{order.num_vertices()}) {}

Vec3l predict_from_counterpart(const RestPrediction& predictor, const HingePairs& pairs,
                               RestAxes& axes) {
  std::array<Hinge, kMaxRestHinges> own{};
  std::array<Hinge, kMaxRestHinges> other{};
  for (std::size_t i = 0; i < pairs.size; ++i) {
    own[i] = pairs.list[i].own;
    other[i] = pairs.list[i].other;
  }
  const auto own_hinges = std::span(own).first(pairs.size);
  axes = predictor.axes(own_hinges);
  return predictor.from_counterpart(own_hinges, axes, std::span(other).first(pairs.size),
                                    pairs.counterpart, pairs.list[0].mirrored);
}

void RestRecon::start(std::uint32_t v, const HingePairs* counterparts) {
  v_ = v;
  const RestPrediction predictor(order_, values_, bits_);
  if (counterparts != nullptr) {
    prediction_ = predict_from_counterpart(predictor, *counterparts, axes_);
  } else {
    prediction_ = predictor.predict(v, {settings_.edge_weight, settings_.ring_weight});
    axes_ = predictor.axes(order_.hinges(v));
  }
  if (!settings_.axes_flag) axes_ = RestPrediction::world();
  if (!settings_.exact_flag) return;
  for (std::int64_t& value : prediction_) value = to_grid(value);
}

void RestRecon::finish(const Vec3i& residual) {
  Vec3l difference{};
  for (std::size_t c = 0; c < kRestFactors; ++c) {
    difference[c] = clip3(-kMaxDifference, kMaxDifference, residual[c] * rest_step_);
  }
  difference = RestPrediction::turned(axes_, difference);
  for (std::size_t c = 0; c < kRestFactors; ++c) {
    values_[std::size_t{v_} * kRestFactors + c] =
        clip_signed(bits_, prediction_[c] + difference[c]);
  }
}

Vector<std::int32_t> recon_rest(RestRecon recon, const RestOrder& order,
                                std::span<const std::int32_t> residuals,
                                std::span<const Counterpart> counterparts) {
  Counterparts found(order);
  for (const std::uint32_t v : order.order()) {
    bool used = false;
    if (!counterparts.empty()) {
      const Counterpart& choice = counterparts[v];
      found.start(v);
      if (choice.new_flag) found.set_new(choice);
      used = choice.flag || choice.new_flag;
    }
    recon.start(v, used ? &found.pairs() : nullptr);
    const std::int32_t* const residual = &residuals[v * kRestFactors];
    recon.finish({residual[0], residual[1], residual[2]});
    if (!counterparts.empty()) found.finish(used);
  }
  return std::move(recon.values());
}

}  // namespace rlpc
