// Searches for the quantiser step that reaches a target error or rate.
#pragma once

#include <cstdint>
#include <functional>

#include "encoder/codec/sequence/target/step_search.h"
#include "encoder/codec/settings.h"

namespace rlpc {

// The quantiser steps that an analysis is valid for, as ratios to the step of the analysis:
// strictly between finest and coarsest. A new analysis is made so that the ratio is made_for.
struct AnalysisRange {
  double finest;
  double made_for;
  double coarsest;
};

// Usage: until finished(), encode with step() and analysis_step(), then report() the result.
// All steps are in grid steps.
class TargetSearch {
 public:
  // Estimates the error at a step, up to a factor almost independent of the step; empty: no
  // estimate.
  using Expected = std::function<double(double step)>;

  // spread: RMS of the coordinates about the mean of their frame, in grid steps.
  // steps_per_unit: grid steps per unit. step_of_error: typical ratio of the step to the RMS
  // error of a coordinate, for the first step.
  TargetSearch(const Target& target, double spread, double steps_per_unit, double step_of_error,
               const AnalysisRange& analysis_range);

  // Sets the first step, before the first encoding, unless there is no target.
  void begin_at(double step) {
    if (target_.has_search()) step_ = step;
  }
  // Sets the first step, before the first encoding, to the one at which the target is expected,
  // if the target is an error. expected: from analyses made for analysis_step().
  void begin_at(const Expected& expected);
  // Declares encodings slow: a KG error of up to 2 % below the target ends the search after
  // five.
  void set_costly() { is_costly_ = true; }
  // Declares time worth more than bytes: a KG error of up to 2 % below the target ends the
  // search.
  void set_quick() { is_quick_ = true; }
  double step() const { return step_; }
  // Returns the step to analyse for. Near the target it is kept as long as it is valid for
  // step(), because the measured value jumps from one analysis to the next.
  double analysis_step() const {
    return serves(frozen_, step_) ? frozen_ : step_ / range_.made_for;
  }
  double last_step() const { return last_step_; }
  // Reports an encoding with step(): its error or rate, in the unit of the target, and its
  // bytes. Returns true if it is the best so far. expected: if the target is an error, the
  // estimate from the analyses of this encoding.
  bool report(double measured, std::uint64_t bytes, const Expected& expected = {});
  bool finished() const { return finished_; }
  // Whether an encoding has come near the target.
  bool is_located() const { return is_located_; }
  // Whether the best encoding does not exceed the target.
  bool met() const { return !target_.has_search() || best_.met(); }

 private:
  bool serves(double analysis_step, double step) const {
    return step > range_.finest * analysis_step && step < range_.coarsest * analysis_step;
  }
  bool is_near(double measured) const;
  void add_to_bracket(double measured);
  bool is_here(double measured) const;
  double tolerance() const;
  double aim() const;
  void choose_next(double measured, const Expected& expected);
  void sample_beyond_jump();
  void narrow_bracket(double aim);
  double factor_to(double aim, double value, const Expected& expected) const;
  double step_for(double value, const Expected& expected) const;

  Target target_;
  AnalysisRange range_;
  double step_ = 1.0;
  double frozen_ = 0.0;  // analysis step kept near the target; 0: none yet
  double last_step_ = 1.0;
  BestEncoding best_;
  Bracket bracket_;
  PowerLaw power_law_;
  double last_measured_ = -1.0;  // below 0: none yet
  int num_equal_ = 0;            // number of earlier encodings with this value
  bool is_costly_ = false;
  bool is_quick_ = false;
  int trials_ = 0;
  bool was_interpolated_ = false;  // step_ was interpolated in a narrow bracket
  double sampled_from_ = 0.0;      // start of the samples beyond a jump; 0: not sampling
  int samples_ = 0;
  bool is_located_ = false;
  bool finished_ = false;
};

}  // namespace rlpc
