#include "encoder/target_search.h"

#include <algorithm>
#include <cmath>

namespace rlpc {
namespace {

constexpr int kMaxTrials = 18;
constexpr double kTolerance = 0.02;     // of the target, below it
constexpr double kFreezeWithin = 0.35;  // of the target
constexpr double kFinestStep = 0.5;     // grid steps
constexpr double kCoarsestStep = 0x1p24;

}  // namespace

TargetSearch::TargetSearch(const Target& target, double spread, double steps_per_unit)
    : target_(target) {
  // Typical ratios of step to error; the search corrects them.
  double first = 64.0;
  if (target.kind == Target::kKg) first = 6.0 * spread * target.value / 100.0;
  if (target.kind == Target::kMaxError) first = target.value * steps_per_unit;
  if (target.kind == Target::kBpvf) first = 0.02 * spread / target.value;
  step_ = std::clamp(first, kFinestStep, kCoarsestStep);
}

bool TargetSearch::report(double measured) {
  ++trials_;
  last_step_ = step_;
  if (target_.kind == Target::kNone) {
    finished_ = true;
    return true;
  }
  const bool within = measured <= target_.value;
  const double ratio = measured / target_.value;
  if (frozen_ == 0.0 && ratio > 1.0 - kFreezeWithin && ratio < 1.0 + kFreezeWithin) {
    // What was measured before belongs to other analyses.
    frozen_ = step_;
    fine_ = coarse_ = 0.0;
  }
  // The rate falls as the step grows, errors rise.
  const bool fine = (target_.kind == Target::kBpvf) != within;
  (fine ? fine_ : coarse_) = step_;
  (fine ? fine_value_ : coarse_value_) = measured;
  // Within the target, the value closest to it is best; while none is, the smallest.
  bool better = trials_ == 1;
  if (within) {
    better = !met_ || measured > best_;
  } else if (!met_) {
    better = better || measured < best_;
  }
  if (better) best_ = measured;
  met_ = met_ || within;
  choose_next(measured);
  return better;
}

void TargetSearch::choose_next(double measured) {
  const double target = target_.value;
  const bool close = met_ && best_ >= target * (1.0 - kTolerance);
  if (close || trials_ >= kMaxTrials) {
    finished_ = true;
    return;
  }
  if (fine_ > 0.0 && coarse_ > 0.0) {
    // Between the two, nearly proportional; aim a little inside the target.
    if (coarse_ / fine_ < 1.0002) {
      finished_ = true;
      return;
    }
    const double aim = target * (1.0 - 0.4 * kTolerance);
    const double share = (aim - fine_value_) / (coarse_value_ - fine_value_);
    // Every third step halves the bracket whatever the values say.
    step_ = trials_ % 3 == 0 ? std::sqrt(fine_ * coarse_)
                             : fine_ + (coarse_ - fine_) * std::clamp(share, 0.02, 0.98);
    return;
  }
  double factor = measured > 0.0 ? target / measured : 16.0;
  if (target_.kind == Target::kBpvf) factor = 1.0 / (factor * factor);
  // Past the target by a little, so that it is bracketed.
  factor = std::clamp(factor * (factor < 1.0 ? 0.97 : 1.02), 0.02, 50.0);
  const double next = std::clamp(step_ * factor, kFinestStep, kCoarsestStep);
  if (next == step_) finished_ = true;  // as fine or as coarse as it goes
  step_ = next;
}

}  // namespace rlpc
