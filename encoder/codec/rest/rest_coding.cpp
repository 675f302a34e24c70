#include "encoder/codec/rest/rest_coding.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "common/codec/kinds/skinned/slice_models.h"
#include "common/codec/mesh_prediction/rest_recon.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/rest/counterpart_search.h"
#include "encoder/codec/spans/lagrangian.h"
#include "encoder/codec/write/bit_cost.h"
#include "encoder/codec/write/write_residual.h"
#include "encoder/codec/write/write_rest.h"

namespace rlpc {
namespace {

// Counts bits as a SectionWriter writes them. Cost: BitCost, or BitEstimate to leave the models
// as they are.
template <class Cost>
class CountingSection {
 public:
  void bin(BitModel& model, bool value) { cost_.bin(model, value); }
  void bypass(int n, std::uint32_t value) { cost_.bypass(n, value); }
  void residual(ResidualModels& models, std::uint32_t expected, std::int32_t value) {
    write_residual(cost_, models, expected, value);
  }
  double bits() const { return cost_.bits(); }

 private:
  Cost cost_;
};

constexpr int kSettingsBits = 2 * kRestWeightBits + 2;  // fixed: format

// Returns D + lambda R, in squared steps. An error of a rest position shows in every frame, and
// its step is finer by the square root of their number, so that both cancel out.
double cost_of(std::span<const std::int32_t> wanted, std::span<const std::int32_t> values,
               double step, double bits) {
  double square = 0.0;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const double d = static_cast<double>(wanted[i] - values[i]);
    square += d * d;
  }
  return square / (step * step) + kLambda * bits;
}

// tuned: The weights that are tried: parallelograms alone, for regular and artificial meshes;
// and between these and the ring, more or less smooth. Others are seldom better by 1 %.
constexpr std::array<RestSettings, 4> kWeights{{{false, true, 16, 0, true, false},
                                                {false, true, 10, 24, true, false},
                                                {false, true, 10, 36, true, false},
                                                {false, true, 12, 16, true, false}}};

// Returns the nearest residual of the vertex that `recon` is at.
Vec3i nearest_residual(const RestRecon& recon, const std::int32_t* wanted, double step) {
  constexpr double kMax = static_cast<double>(kMaxResidual);        // fixed: format
  constexpr double kAxisUnit = 1.0 / static_cast<double>(1 << 30);  // fixed: format
  std::array<double, kRestFactors> difference{};
  for (std::size_t c = 0; c < kRestFactors; ++c) {
    difference[c] = static_cast<double>(wanted[c] - recon.prediction()[c]);
  }
  Vec3i residual{};
  for (std::size_t i = 0; i < kRestFactors; ++i) {
    double along = 0.0;
    for (std::size_t c = 0; c < kRestFactors; ++c) {
      along += static_cast<double>(recon.axes()[i][c]) * kAxisUnit * difference[c];
    }
    residual[i] =
        static_cast<std::int32_t>(round_to_int(std::clamp(along / step, -kMax, kMax)));
  }
  return residual;
}

// Codes rest positions with given settings.
class RestCoder {
 public:
  RestCoder(const RestOrder& order, std::span<const std::int32_t> wanted,
            std::uint32_t rest_step, int position_bits, const RestSettings& settings)
      : order_(order),
        wanted_(wanted),
        step_(rest_step),
        recon_(order, settings, rest_step, position_bits),
        writer_(order) {
    coded_.settings = settings;
    coded_.residual.resize(wanted.size());
    if (!settings.counterparts_flag) return;
    coded_.counterparts.resize(order.num_vertices());
    search_.emplace(order, wanted, rest_step, position_bits);
  }

  RestEncoding code() {
    for (const std::uint32_t v : order_.order()) {
      writer_.start(v);
      if (search_) choose_counterpart(v);
      const HingePairs& pairs = writer_.counterparts().pairs();
      const bool used =
          search_ && (coded_.counterparts[v].flag || coded_.counterparts[v].new_flag);
      recon_.start(v, used ? &pairs : nullptr);
      const Vec3i residual = nearest_residual(recon_, &wanted_[v * kRestFactors], step_);
      recon_.finish(residual);
      writer_.finish(section_, residual);
      for (std::size_t c = 0; c < kRestFactors; ++c) {
        coded_.residual[v * kRestFactors + c] = residual[c];
      }
      if (search_) search_->add(v, used);
    }
    coded_.values = std::move(recon_.values());
    coded_.bits = section_.bits() + kSettingsBits;
    coded_.cost = cost_of(wanted_, coded_.values, step_, coded_.bits);
    return std::move(coded_);
  }

 private:
  // Returns the bits of v as it would be coded.
  double bits_of(std::uint32_t v, const Counterpart& choice, const HingePairs* pairs) {
    CountingSection<BitEstimate> estimate;
    writer_.estimate_counterpart(estimate, choice);
    recon_.start(v, pairs);
    writer_.estimate_residual(estimate, pairs != nullptr,
                              nearest_residual(recon_, &wanted_[v * kRestFactors], step_));
    return estimate.bits();
  }

  void choose_counterpart(std::uint32_t v) {
    Counterpart& choice = coded_.counterparts[v];
    const Counterparts& counterparts = writer_.counterparts();
    double min = bits_of(v, choice, nullptr);
    if (counterparts.is_inherited()) {
      Counterpart inherited;
      inherited.flag = true;
      const double bits = bits_of(v, inherited, &counterparts.pairs());
      if (bits < min) {
        min = bits;
        choice = inherited;
      }
    }
    // An inherited counterpart can be inherited further: a new one gains nothing.
    const auto found = choice.flag ? std::nullopt : search_->find(v, counterparts);
    if (found) {
      const HingePairs pairs = counterparts.new_pairs(found->choice);
      if (bits_of(v, found->choice, &pairs) - found->gain < min) choice = found->choice;
    }
    writer_.counterpart(section_, choice);
  }

  const RestOrder& order_;
  std::span<const std::int32_t> wanted_;
  double step_;
  RestEncoding coded_;
  RestRecon recon_;
  CountingSection<BitCost> section_;
  RestWriter writer_;
  std::optional<CounterpartSearch> search_;
};

}  // namespace

RestEncoding code_rest_in_order(const OrderedMesh& mesh, std::span<const std::int32_t> wanted,
                                std::uint32_t rest_step, int position_bits,
                                const RestChoices& choices) {
  std::optional<RestEncoding> best;
  const auto attempt = [&](const RestSettings& settings) {
    RestEncoding coded =
        RestCoder(mesh.rest_order(), wanted, rest_step, position_bits, settings).code();
    if (!best || coded.cost < best->cost) best = std::move(coded);
  };
  const std::size_t count = choices.few ? 2 : kWeights.size();
  for (std::size_t i = 0; i < count; ++i) {
    RestSettings settings = kWeights[i];
    settings.exact_flag = choices.exact;
    settings.axes_flag = !choices.exact;
    attempt(settings);
  }
  if (choices.few) return std::move(*best);
  if (!choices.exact) {
    RestSettings on_world = best->settings;
    on_world.axes_flag = false;
    attempt(on_world);
  }
  if (choices.counterparts) {
    RestSettings with_counterparts = best->settings;
    with_counterparts.counterparts_flag = true;
    attempt(with_counterparts);
  }
  return std::move(*best);
}

double rest_cost_in_layers(const OrderedMesh& mesh, std::span<const std::int32_t> wanted,
                           std::uint32_t rest_step, std::span<const std::int32_t> residual,
                           std::span<const std::int32_t> values) {
  VertexModels models;
  VertexContexts contexts(mesh, kRestFactors);
  CountingSection<BitCost> section;
  for (const std::uint32_t v : mesh.order()) {
    contexts.start(v);
    for (std::size_t c = 0; c < kRestFactors; ++c) {
      const std::int32_t x = residual[v * kRestFactors + c];
      section.residual(models[contexts.activity()], contexts.expected(), x);
      contexts.update(x);
    }
  }
  return cost_of(wanted, values, rest_step, section.bits());
}

}  // namespace rlpc
