// Units of moved points and of steps (8.19), as the encoder's floating point needs them.
#pragma once

#include "common/codec/bits/fixed_point.h"

namespace rlpc {

// Units of a moved point in one grid step.
inline constexpr double kPointUnits = 1 << kPointFractionBits;  // fixed: format
// Units of a moved point in one unit of a layer's step.
inline constexpr double kStepUnits = kPointUnits / 256.0;  // fixed: format

}  // namespace rlpc
