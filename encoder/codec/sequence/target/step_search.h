// Parts of TargetSearch: the knowledge from its trials so far.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "encoder/codec/math/det_math.h"
#include "encoder/codec/settings.h"

namespace rlpc {

// The best encoding so far.
class BestEncoding {
 public:
  explicit BestEncoding(const Target& target) : target_(target) {}

  // Adds an encoding. Returns true if it is the best so far. tolerance: relative distance below
  // the target that counts as close.
  bool offer(double measured, std::uint64_t bytes, double tolerance) {
    const bool better = is_better(measured, bytes);
    const bool within = measured <= target_.value;
    is_first_ = false;
    met_ = met_ || within;
    close_ = close_ || (within && measured >= target_.value * (1.0 - tolerance));
    if (better) {
      measured_ = measured;
      bytes_ = bytes;
    }
    return better;
  }
  bool met() const { return met_; }      // whether an encoding does not exceed the target
  bool close() const { return close_; }  // whether one is also within the tolerance
  // Whether the best does not exceed the target, and is at most this fraction below it.
  bool met_within(double fraction) const {
    return met_ && measured_ >= target_.value * (1.0 - fraction);
  }

 private:
  // Among encodings that meet the target, the one closest to it usually wins. But errors jump
  // when the analysis changes, so an encoding whose error is 1 % further below the target wins
  // if it saves more than 1 % of the bytes. If none meets the target, the smallest value wins.
  bool is_better(double measured, std::uint64_t bytes) const {
    if (measured > target_.value) return is_first_ || (!met_ && measured < measured_);
    if (!met_) return true;
    if (target_.kind == Target::kBpvf) return measured > measured_;
    const auto cost = [&](double value, std::uint64_t size) {
      return static_cast<double>(size) * (2.0 - value / target_.value);
    };
    return cost(measured, bytes) < cost(measured_, bytes_);
  }

  Target target_;
  double measured_ = 0.0;
  std::uint64_t bytes_ = 0;
  bool is_first_ = true;
  bool met_ = false;
  bool close_ = false;
};

// The tried steps on either side of the target, with their measured values.
class Bracket {
 public:
  void add_fine(double step, double value) { fine_ = {step, value}; }
  void add_coarse(double step, double value) { coarse_ = {step, value}; }
  bool closed() const { return fine_.step > 0.0 && coarse_.step > 0.0; }
  bool within(double factor) const { return coarse_.step < factor * fine_.step; }
  double coarse_step() const { return coarse_.step; }
  // Returns the step at which linear interpolation gives the value `aim`.
  double interpolate(double aim) const {
    constexpr double kEnd = 0.02;  // fixed: never at a known end
    const double fraction = (aim - fine_.value) / (coarse_.value - fine_.value);
    return fine_.step + (coarse_.step - fine_.step) * std::clamp(fraction, kEnd, 1.0 - kEnd);
  }
  double middle() const { return std::sqrt(fine_.step * coarse_.step); }

 private:
  struct End {
    double step = 0.0;  // 0: none yet
    double value = 0.0;
  };
  End fine_;    // the last step that was too fine or exact
  End coarse_;  // the last step that was too coarse
};

// Models measured values as a power of the step.
class PowerLaw {
 public:
  explicit PowerLaw(double usual_exponent) : usual_(usual_exponent), exponent_(usual_) {}

  double usual_exponent() const { return usual_; }
  double exponent() const { return exponent_; }
  // Sets the exponent to the slope between this encoding and the previous one, clamped to the
  // range from flattest to steepest times the usual exponent. value: above 0.
  void add(double step, double value, double flattest, double steepest) {
    if (last_value_ > 0.0 && value != last_value_ && step != last_step_) {
      const double rise = det_log2(value / last_value_) / det_log2(step / last_step_);
      exponent_ = std::clamp(rise / usual_, flattest, steepest) * usual_;
    }
    last_value_ = value;
    last_step_ = step;
  }

 private:
  double usual_;
  double exponent_;
  double last_value_ = 0.0;  // 0: none yet
  double last_step_ = 1.0;
};

}  // namespace rlpc
