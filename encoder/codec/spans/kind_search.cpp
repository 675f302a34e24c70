#include "encoder/codec/spans/kind_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// Returns the bits of the shared rig of a span; 0: none.
double bits_of_rig(const EncodedSpan& encoded) {
  if (encoded.units.empty() || encoded.units.front().type != UnitType::kRig) return 0.0;
  const auto gof = std::find_if(encoded.units.begin(), encoded.units.end(),
                                [](const auto& unit) { return unit.type == UnitType::kGof; });
  return bits_of(std::span(encoded.units.begin(), gof));
}

// Returns the cost of a coder at about another squared error. cost: that of encode(step).
SpanCost cost_at_error(SpanCoder& coder, const SpanFrames& frames, double step,
                       const SpanCost& cost, double squared_error) {
  // fixed: bits_at_equal_error() is right about smaller differences.
  constexpr double kNear = 1.1;
  constexpr int kMaxTrials = 2;  // fixed: the error barely differs from its forecast
  SpanCost found = cost;
  double scaled = step;
  for (int i = 0; i < kMaxTrials && found.squared_error > 0.0 && squared_error > 0.0; ++i) {
    const double ratio = squared_error / found.squared_error;
    if (is_within(kNear, ratio, 1.0)) break;
    scaled *= std::sqrt(ratio);
    found = cost_of(coder.encode(scaled, scaled), frames);
  }
  // A kind that cannot err as much gains nothing by that.
  found.squared_error = std::max(found.squared_error, squared_error);
  return found;
}

}  // namespace

KindSearch::KindSearch(const KindEncoders& kinds, const SpanFrames& frames, Preset preset)
    : kinds_(kinds), frames_(frames), preset_(preset), coders_(kinds.size()) {
  coders_.front() = kinds_.front()->make_coder(frames_);
}

void KindSearch::set_progress(const Progress& progress) {
  coders_.front()->set_progress(progress);
}

void KindSearch::analyse(double analysis_step) { coders_[chosen_]->analyse(analysis_step); }

std::optional<double> KindSearch::expected_error(double step) const {
  return coders_[chosen_]->expected_error(step);
}

bool KindSearch::needs_frames(double step, double analysis_step) const {
  return must_compare() || coders_[chosen_]->needs_frames(step, analysis_step);
}

EncodedSpan KindSearch::encode(double step, double analysis_step) {
  return must_compare() ? compare(step, analysis_step)
                        : coders_[chosen_]->encode(step, analysis_step);
}

EncodedSpan KindSearch::compare(double step, double analysis_step) {
  is_compared_ = true;
  EncodedSpan best = coders_.front()->encode(step, analysis_step);
  SpanCost best_cost = cost_of(best, frames_);
  // At least one more span uses its rig, so that it counts half.
  if (frames_.has_followers) best_cost.bits -= 0.5 * bits_of_rig(best);
  for (std::size_t k = 1; k < kinds_.size(); ++k) {
    std::unique_ptr<SpanCoder> coder = kinds_[k]->make_coder(frames_);
    const std::optional<double> near =
        preset_ == Preset::kSlow ? step : coder->step_in_reach(step, best_cost);
    if (!near) continue;
    is_contested_ = true;
    EncodedSpan encoded = coder->encode(*near, *near == step ? analysis_step : *near);
    SpanCost cost = cost_of(encoded, frames_);
    const SpanCost at_equal_error =
        cost_at_error(*coder, frames_, *near, cost, best_cost.squared_error);
    // fixed: by less, the likeliest kind is kept: it decodes faster, and becomes a skin in
    // glTF.
    constexpr double kWorthIt = 0.98;
    if (ratio_at_equal_error(at_equal_error, best_cost) >= kWorthIt) continue;
    if (*near != step) {
      encoded = coder->encode(step, analysis_step);
      cost = cost_of(encoded, frames_);
    }
    if (chosen_ > 0) coders_[chosen_].reset();
    coders_[k] = std::move(coder);
    chosen_ = k;
    best = std::move(encoded);
    best_cost = cost;
  }
  return best;
}

void KindSearch::release_analysis() {
  for (const auto& coder : coders_) {
    if (coder) coder->release_analysis();
  }
}

}  // namespace rlpc
