// Keeps the error of frames that are coded as they arrive near a target, by their steps.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/codec/kinds/inter/inter_gof.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {

// Integral control. The error of a frame in steps is not known before it is coded, and changes
// slowly: it depends on how well motion is predicted.
class StepControl {
 public:
  // Adds the squared error of a frame, relative to the one that would meet the target. surplus:
  // what all frames so far are below the target, in the same unit.
  void add(double squared_error, double surplus) {
    const double wanted = std::clamp(1.0 + surplus / kFrames, kMinWanted, kMaxWanted);
    log2_ += kGain * 0.5 * det_log2(wanted / std::max(squared_error, kMinError));
    log2_ = std::clamp(log2_, -kMaxLog2, kMaxLog2);
  }
  // Returns the step of the next frame, relative to that of the first.
  double factor() const { return det_exp2(log2_); }
  // Returns frame_step_delta of a frame that has about this step.
  std::int32_t delta() const {
    return std::clamp(
        static_cast<std::int32_t>(std::floor(kDeltaUnits * (factor() - 1.0) + 0.5)),
        kMinStepDelta, kMaxStepDelta);
  }
  // Makes the next frame the one that others are relative to.
  void start_again() { log2_ = 0.0; }

 private:
  static constexpr double kDeltaUnits = 16.0;  // fixed: format
  // fixed: half a second, in which errors are made up for. 15 to 60 frames, and gains of 0.1 to
  // 0.3, give the same bytes within 2 % on five animations; 15 ends nearest to the target.
  static constexpr double kFrames = 15.0;
  static constexpr double kGain = 0.3;       // fixed: as above
  static constexpr double kMinWanted = 0.5;  // fixed: a guard
  static constexpr double kMaxWanted = 2.0;  // fixed: a guard
  static constexpr double kMinError = 1e-6;  // fixed: above zero
  static constexpr double kMaxLog2 = 3.0;    // fixed: a guard

  double log2_ = 0.0;
};

}  // namespace rlpc
