// Finds the quantiser step that reaches a target error or rate.
#pragma once

#include <cstdint>
#include <functional>

#include "encoder/rlpc_encoder.h"
#include "encoder/sequence/step_search.h"

namespace rlpc {

// Steps relative to that of an analysis: it is made for one that serves those in between.
struct AnalysisRange {
  double finest;
  double made_for;
  double coarsest;
};

// Ask step(), encode, tell report() what was measured; again until finished().
class TargetSearch {
 public:
  // What a step will give, but for a factor that hardly depends on it; empty: nothing is known.
  using Expected = std::function<double(double step)>;

  // spread: root mean square of the coordinates about their frame's mean; steps_per_unit: of
  // the grid. step_of_error: typical ratio of the step to the error of a coordinate, to start
  // with. Steps are in grid steps.
  TargetSearch(const Target& target, double spread, double steps_per_unit, double step_of_error,
               const AnalysisRange& analysis_range);

  // Before the first encoding: the step to try first, where a target is searched for.
  void begin_at(double step) {
    if (target_.kind != Target::kNone) step_ = step;
  }
  // Where the target, an error, is expected by analyses that are there, for analysis_step().
  void begin_at(const Expected& expected);
  double step() const { return step_; }
  // The step that the analysis is made for. Close to the target it stays as it is, as the
  // measured value jumps from one analysis to the next; but it serves nearby steps only.
  double analysis_step() const {
    return serves(frozen_, step_) ? frozen_ : step_ / range_.made_for;
  }
  double last_step() const { return last_step_; }
  // What an encoding came to: the error or rate that is searched for, and all its bytes.
  // True if it is the best so far. expected: of an error, by the same analyses.
  bool report(double measured, std::uint64_t bytes, const Expected& expected = {});
  bool finished() const { return finished_; }
  // The best encoding does not exceed the target.
  bool met() const { return target_.kind == Target::kNone || best_.met(); }

 private:
  bool serves(double analysis_step, double step) const {
    return step > range_.finest * analysis_step && step < range_.coarsest * analysis_step;
  }
  bool is_near(double measured) const;
  void choose_next(double measured, const Expected& expected);
  void sample_beyond_jump();
  void narrow_bracket(double aim);
  double factor_to(double aim, double value, const Expected& expected) const;
  double step_for(double value, const Expected& expected) const;

  Target target_;
  AnalysisRange range_;
  double step_ = 1.0;
  double frozen_ = 0.0;  // analysis step; 0: not yet
  double last_step_ = 1.0;
  BestEncoding best_;
  Bracket bracket_;
  PowerLaw power_law_;
  int trials_ = 0;
  double sampled_from_ = 0.0;  // the step that others are tried beyond; 0: none yet
  int samples_ = 0;
  bool finished_ = false;
};

}  // namespace rlpc
