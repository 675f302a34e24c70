#include "encoder/sequence/target_search.h"

#include <algorithm>
#include <cmath>

#include "encoder/math/det_math.h"

namespace rlpc {
namespace {

constexpr int kMaxTrials = 18;
constexpr double kTolerance = 0.02;  // of the target, below it
constexpr double kFinestStep = 0.5;  // grid steps
constexpr double kCoarsestStep = 0x1p24;
constexpr double kFarthest = 50.0;  // from one step to the next, as a factor
// Slopes that are believed, relative to the usual one.
constexpr double kFlattest = 0.5;
constexpr double kSteepest = 2.0;
// Largest errors jump from step to step. Where they do, a narrower bracket tells nothing: some
// steps beyond it are tried instead, as one of them may do as well by chance.
constexpr double kNarrow = 1.006;
constexpr int kSamples = 8;
constexpr double kBetweenSamples = 0.006;  // relative

}  // namespace

TargetSearch::TargetSearch(const Target& target, double spread, double steps_per_unit,
                           double step_of_error, const AnalysisRange& analysis_range)
    : target_(target), range_(analysis_range), slope_(usual_slope()) {
  double first = 64.0;
  if (target.kind == Target::kKg) first = step_of_error * spread * target.value / 100.0;
  if (target.kind == Target::kMaxError) first = target.value * steps_per_unit;
  if (target.kind == Target::kBpvf) first = 0.02 * spread / target.value;
  step_ = std::clamp(first, kFinestStep, kCoarsestStep);
}

void TargetSearch::begin_at(const Expected& expected) {
  constexpr double kFar = 2.5;  // expectations that are farther off are not believed
  if (target_.kind == Target::kNone) return;
  frozen_ = analysis_step();
  step_ = std::clamp(step_for(target_.value, expected), step_ / kFar, step_ * kFar);
}

// Within the target, mostly the value closest to it. But errors jump where the analysis does:
// one that is a per cent farther off is better if it saves more than a per cent of the bytes.
// While none is within the target, the smallest value.
bool TargetSearch::is_better(double measured, std::uint64_t bytes) const {
  if (measured > target_.value) return trials_ == 0 || (!met_ && measured < best_);
  if (!met_) return true;
  if (target_.kind == Target::kBpvf) return measured > best_;
  const auto cost = [&](double value, std::uint64_t size) {
    return static_cast<double>(size) * (2.0 - value / target_.value);
  };
  return cost(measured, bytes) < cost(best_, best_bytes_);
}

bool TargetSearch::report(double measured, std::uint64_t bytes, const Expected& expected) {
  const bool better = is_better(measured, bytes);
  ++trials_;
  last_step_ = step_;
  if (target_.kind == Target::kNone) {
    finished_ = true;
    return true;
  }
  const bool within = measured <= target_.value;
  if (analysis_step() != frozen_ && is_near(measured)) {
    // What was measured before belongs to other analyses.
    frozen_ = analysis_step();
    fine_ = coarse_ = 0.0;
  }
  // The rate falls as the step grows, errors rise.
  const bool fine = (target_.kind == Target::kBpvf) != within;
  (fine ? fine_ : coarse_) = step_;
  (fine ? fine_value_ : coarse_value_) = measured;
  if (better) {
    best_ = measured;
    best_bytes_ = bytes;
  }
  close_ = close_ || (within && measured >= target_.value * (1.0 - kTolerance));
  met_ = met_ || within;
  choose_next(measured, expected);
  return better;
}

// Whether the analysis for this step serves for the one that reaches the target.
bool TargetSearch::is_near(double measured) const {
  const double ratio = measured / target_.value;
  if (!(ratio > 0.5 && ratio < 2.0)) return false;
  const double factor = det_exp2(-det_log2(ratio) / usual_slope());
  return serves(analysis_step(), factor * step_);
}

// Where such a value is expected: for errors, which rise with the step.
double TargetSearch::step_for(double value, const Expected& expected) const {
  constexpr int kHalvings = 20;
  double low = step_ / kFarthest;
  double high = step_ * kFarthest;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(low * high);
    (expected(middle) > value ? high : low) = middle;
  }
  return std::clamp(low, kFinestStep, kCoarsestStep);
}

void TargetSearch::choose_next(double measured, const Expected& expected) {
  const double target = target_.value;
  if (close_ || trials_ >= kMaxTrials) {
    finished_ = true;
    return;
  }
  const bool jumps = target_.kind == Target::kMaxError && fine_ > 0.0 && coarse_ > 0.0 &&
                     coarse_ < kNarrow * fine_;
  if (jumps && sampled_from_ == 0.0) sampled_from_ = coarse_;
  if (sampled_from_ > 0.0) {
    ++samples_;
    if (samples_ > kSamples) finished_ = true;
    step_ = std::min(sampled_from_ * (1.0 + kBetweenSamples * samples_), kCoarsestStep);
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
  // Errors and rates are nearly powers of the step.
  constexpr double kBeyond = 1e9;  // more, or less, does not matter
  const double value = std::clamp(measured, target / kBeyond, target * kBeyond);
  if (last_value_ > 0.0 && value != last_value_ && step_ != previous_step_) {
    const double rise = det_log2(value / last_value_) / det_log2(step_ / previous_step_);
    slope_ = std::clamp(rise / usual_slope(), kFlattest, kSteepest) * usual_slope();
  }
  last_value_ = value;
  previous_step_ = step_;
  const double aim = target * (1.0 - 0.4 * kTolerance);
  const double rise = det_log2(aim / value);
  double factor = det_exp2(rise / slope_);
  if (expected && expected(step_) > 0.0) {
    // Errors rise a little less than expected.
    constexpr double kMore = 1.08;
    const double flat = det_exp2(rise / (kFlattest * usual_slope()));
    const double steep = det_exp2(rise / (kSteepest * usual_slope()));
    factor = std::clamp(step_for(expected(step_) * det_exp2(kMore * rise), expected) / step_,
                        std::min(flat, steep), std::max(flat, steep));
  }
  factor = std::clamp(factor, 1.0 / kFarthest, kFarthest);
  const double next = std::clamp(step_ * factor, kFinestStep, kCoarsestStep);
  if (next == step_) finished_ = true;  // as fine or as coarse as it goes
  step_ = next;
}

}  // namespace rlpc
