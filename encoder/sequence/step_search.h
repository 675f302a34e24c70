// What a search for a step learns from its encodings: parts of TargetSearch.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "encoder/math/det_math.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// The best encoding so far.
class BestEncoding {
 public:
  explicit BestEncoding(const Target& target) : target_(target) {}

  // True if it is the best so far. tolerance: of the target, below it.
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
  bool met() const { return met_; }      // some encoding is within the target
  bool close() const { return close_; }  // and as close to it as asked for

 private:
  // Within the target, usually the value closest to it. But errors jump where the analysis
  // does: one that is a per cent farther off is better if it saves more than a per cent of the
  // bytes. While none is within the target, the smallest value.
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

// The steps next to the one that reaches the target, and what they measure.
class Bracket {
 public:
  void add_fine(double step, double value) { fine_ = {step, value}; }
  void add_coarse(double step, double value) { coarse_ = {step, value}; }
  bool closed() const { return fine_.step > 0.0 && coarse_.step > 0.0; }
  bool within(double factor) const { return coarse_.step < factor * fine_.step; }
  double coarse_step() const { return coarse_.step; }
  // Where the value is `aim` if it is linear between the two.
  double interpolate(double aim) const {
    constexpr double kEnd = 0.02;  // fixed: never at an end that is known
    const double share = (aim - fine_.value) / (coarse_.value - fine_.value);
    return fine_.step + (coarse_.step - fine_.step) * std::clamp(share, kEnd, 1.0 - kEnd);
  }
  double middle() const { return std::sqrt(fine_.step * coarse_.step); }

 private:
  struct End {
    double step = 0.0;  // 0: none
    double value = 0.0;
  };
  End fine_;    // the last step that was too fine, or just right
  End coarse_;  // the last one that was too coarse
};

// Measured values as a power of the step.
class PowerLaw {
 public:
  explicit PowerLaw(double usual_exponent) : usual_(usual_exponent), exponent_(usual_) {}

  double usual_exponent() const { return usual_; }
  double exponent() const { return exponent_; }
  // The exponent is that between this encoding and the last, within the given range of the
  // usual one. value: above 0.
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
  double last_value_ = 0.0;  // 0: none
  double last_step_ = 1.0;
};

}  // namespace rlpc
