#include "encoder/codec/sequence/target/target_search.h"

#include <algorithm>
#include <cmath>

#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

constexpr int kMaxTrials = 18;  // fixed: a search ends
// Parts of the target that an encoding may be below it to end the search; promises to users.
constexpr double kTolerance = 0.006;  // fixed: 0.3 % of the bytes
// The same of the largest error, which jumps with the step, so that more encodings would rarely
// come closer; and of the KG error, where time is worth more.
constexpr double kWideTolerance = 0.02;   // fixed: time
constexpr double kFinestStep = 0.5;       // fixed: grid steps
constexpr double kCoarsestStep = 0x1p24;  // fixed: grid steps
constexpr double kFarthest = 50.0;        // fixed: factor from one step to the next
// Exponents are clamped to this factor above and below the usual one.
constexpr double kSteepest = 2.0;  // fixed: a guard against wrong expectations
// The maximum error is a discontinuous function of the step. At a jump, narrowing the bracket
// is useless. Instead, coarser steps beyond the bracket are sampled: one of them may happen to
// meet the target.
constexpr double kNarrow = 1.0 + kWideTolerance / 4.0;  // fixed: by the tolerance
// tuned (off: 0): Number of coarser steps that are tried where the largest error jumps, with
// --max-error. Each is one more encoding, and may be smaller by chance.
constexpr int kSamples = 8;

// tuned (off: -1): The rate is assumed to be this power of the step until two encodings show
// the real slope. It gives the first step of a search for a rate, and how far the second is
// from it.
constexpr double kRateExponent = -0.5;

// tuned (off: 1): The same for the KG error: the error of uncoded components and of rounding to
// zero grows more slowly than the step.
constexpr double kErrorExponent = 0.85;

// Returns the usual exponent of the measured value as a power of the step.
double usual_exponent(const Target& target) {
  if (target.kind == Target::kBpvf) return kRateExponent;
  return target.kind == Target::kKg ? kErrorExponent : 1.0;
}

}  // namespace

TargetSearch::TargetSearch(const Target& target, double spread, double steps_per_unit,
                           double step_of_error, const AnalysisRange& analysis_range)
    : target_(target),
      range_(analysis_range),
      best_(target),
      power_law_(usual_exponent(target)) {
  constexpr double kWithoutTarget = 64.0;  // fixed: grid steps
  // A usual stream has a KG error of 0.1 % at 1 bpvf; from there, the rate is a power of the
  // step.
  constexpr double kUsualError = 0.1;  // fixed: round figure
  double first = kWithoutTarget;
  const double step_of_percent = step_of_error * spread / 100.0;
  if (target.kind == Target::kKg) first = step_of_percent * target.value;
  if (target.kind == Target::kMaxError) first = target.value * steps_per_unit;
  if (target.kind == Target::kBpvf) {
    first = step_of_percent * kUsualError * det_exp2(det_log2(target.value) / kRateExponent);
  }
  step_ = std::clamp(first, kFinestStep, kCoarsestStep);
}

void TargetSearch::begin_at(const Expected& expected) {
  if (!target_.has_search()) return;
  frozen_ = 0.0;
  step_ = step_for(aim(), expected);
}

bool TargetSearch::report(double measured, std::uint64_t bytes, const Expected& expected) {
  last_step_ = step_;
  ++trials_;
  if (!target_.has_search()) {
    finished_ = true;
    return true;
  }
  const bool better = best_.offer(measured, bytes, tolerance());
  if (analysis_step() != frozen_ && is_near(measured)) {
    // Earlier measurements belong to other analyses.
    frozen_ = analysis_step();
    bracket_ = {};
  }
  add_to_bracket(measured);
  if (!is_located_ && is_here(measured)) {
    // Earlier encodings may have other numbers of components.
    is_located_ = true;
    bracket_ = {};
    add_to_bracket(measured);
  }
  choose_next(measured, expected);
  return better;
}

// As the step grows, the rate falls and errors rise.
void TargetSearch::add_to_bracket(double measured) {
  const bool fine = (target_.kind == Target::kBpvf) != (measured <= target_.value);
  if (fine) {
    bracket_.add_fine(step_, measured);
  } else {
    bracket_.add_coarse(step_, measured);
  }
}

// Whether the target is near the last step, or between two steps that are.
bool TargetSearch::is_here(double measured) const {
  // fixed: the best number of components barely changes. A rate changes half as much as the
  // step.
  constexpr double kNear = 0.1;
  constexpr double kNearRate = kNear / 2.0;  // fixed: see above
  constexpr double kApart = 1.2;             // fixed: of two steps, for the same reason
  const double near = target_.kind == Target::kBpvf ? kNearRate : kNear;
  return std::abs(measured - target_.value) < near * target_.value ||
         (bracket_.closed() && bracket_.within(kApart));
}

double TargetSearch::tolerance() const {
  const bool is_wide =
      target_.kind == Target::kMaxError || (is_quick_ && target_.kind == Target::kKg);
  return is_wide ? kWideTolerance : kTolerance;
}

double TargetSearch::aim() const { return target_.value * (1.0 - 0.5 * tolerance()); }

// Whether the current analysis is valid for the step at which the target is expected.
bool TargetSearch::is_near(double measured) const {
  const double ratio = measured / target_.value;
  if (!(ratio > 0.5 && ratio < 2.0)) return false;
  const double factor = det_exp2(-det_log2(ratio) / power_law_.usual_exponent());
  return serves(analysis_step(), factor * step_);
}

// Returns the step at which `value` is expected, by bisection; only for errors, which rise with
// the step.
double TargetSearch::step_for(double value, const Expected& expected) const {
  constexpr int kHalvings = 20;  // fixed: rounding
  double low = step_ / kFarthest;
  double high = step_ * kFarthest;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (expected(middle) > value ? high : low) = middle;
  }
  return std::clamp(low, kFinestStep, kCoarsestStep);
}

void TargetSearch::choose_next(double measured, const Expected& expected) {
  // The KG error jumps where one more trajectory is worth coding: there, interpolation misses
  // even in a narrow bracket, and so would further trials.
  constexpr int kUsualTrials = 5;     // fixed: a promise about time
  constexpr int kEnoughTrials = 7;    // fixed: a promise about time where the error jumps
  constexpr double kJump = 1.004;     // fixed: width of a bracket, less than the tolerance
  constexpr int kCostlyTrials = 5;    // fixed: a promise about time
  constexpr double kFarBelow = 0.02;  // fixed: part of the target; a promise to users
  const bool enough_of_costly = is_costly_ && target_.kind == Target::kKg &&
                                trials_ >= kCostlyTrials && best_.met_within(kFarBelow);
  const bool is_jump =
      target_.kind == Target::kKg && bracket_.closed() && bracket_.within(kJump);
  const bool enough_of_usual =
      (was_interpolated_ && trials_ >= kUsualTrials && best_.met_within(kFarBelow)) ||
      (is_jump && trials_ >= kEnoughTrials && best_.met());
  const bool enough = enough_of_usual || enough_of_costly;
  if (best_.close() || enough || trials_ >= kMaxTrials) {
    finished_ = true;
    return;
  }
  const bool jumps =
      target_.kind == Target::kMaxError && bracket_.closed() && bracket_.within(kNarrow);
  if (jumps || sampled_from_ > 0.0) return sample_beyond_jump();
  if (bracket_.closed()) return narrow_bracket(aim());
  constexpr double kBeyond = 1e9;  // fixed: more, or less, does not matter
  const double value = std::clamp(measured, target_.value / kBeyond, target_.value * kBeyond);
  power_law_.add(step_, value, 1.0 / kSteepest, kSteepest);
  // If the value does not change, each step goes twice as far as the one before.
  num_equal_ = measured == last_measured_ ? num_equal_ + 1 : 0;
  last_measured_ = measured;
  const double far = exact_exp2(num_equal_) * det_log2(factor_to(aim(), value, expected));
  const double factor = det_exp2(std::clamp(far, -det_log2(kFarthest), det_log2(kFarthest)));
  const double next = std::clamp(step_ * factor, kFinestStep, kCoarsestStep);
  if (next == step_) finished_ = true;  // at the finest or coarsest step
  step_ = next;
}

void TargetSearch::sample_beyond_jump() {
  if (sampled_from_ == 0.0) sampled_from_ = bracket_.coarse_step();
  ++samples_;
  if (samples_ > kSamples) finished_ = true;
  step_ = std::min(sampled_from_ * (1.0 + (kNarrow - 1.0) * samples_), kCoarsestStep);
}

// Chooses the next step by interpolation, or every third time by bisection.
void TargetSearch::narrow_bracket(double aim) {
  constexpr double kAsOne = 1.0002;  // fixed: two ends of a bracket
  if (bracket_.within(kAsOne)) {
    finished_ = true;
    return;
  }
  constexpr int kHalving = 3;  // fixed: keeps interpolation from stalling
  const bool halves = trials_ % kHalving == 0;
  constexpr double kNarrowKg = 1.06;  // fixed: where errors are linear to within the tolerance
  was_interpolated_ = !halves && target_.kind == Target::kKg && bracket_.within(kNarrowKg);
  step_ = halves ? bracket_.middle() : bracket_.interpolate(aim);
}

// Returns the factor from the current step to the one whose value should be `aim`.
double TargetSearch::factor_to(double aim, double value, const Expected& expected) const {
  const double rise = det_log2(aim / value);
  if (!expected || !(expected(step_) > 0.0)) return det_exp2(rise / power_law_.exponent());
  const double usual = power_law_.usual_exponent();
  const double flat = det_exp2(rise * kSteepest / usual);
  const double steep = det_exp2(rise / (kSteepest * usual));
  return std::clamp(step_for(expected(step_) * aim / value, expected) / step_,
                    std::min(flat, steep), std::max(flat, steep));
}

}  // namespace rlpc
