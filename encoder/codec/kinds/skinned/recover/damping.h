// The damping of Gauss-Newton steps (Levenberg and Marquardt).
#pragma once

#include <algorithm>

namespace rlpc {

// Steps that lower the error are followed by bolder ones, others are tried again with more
// damping.
class Damping {
 public:
  explicit Damping(double start) : value_(start) {}
  double value() const { return value_; }  // part of the diagonal that is added to it
  bool is_spent() const { return value_ > kMax; }
  void relax() { value_ = std::max(kRelaxed * value_, kMin); }
  void tighten() { value_ *= kTightened; }

 private:
  static constexpr double kRelaxed = 0.3;    // fixed: usual
  static constexpr double kTightened = 5.0;  // fixed: usual
  static constexpr double kMin = 1e-8;       // fixed: rounding
  static constexpr double kMax = 1e3;        // fixed: steps are then too short to gain anything

  double value_;
};

}  // namespace rlpc
