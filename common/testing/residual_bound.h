// The largest magnitude of a residual, for tests of what residuals may be.
#pragma once

#include <cstdint>

#include "common/codec/bits/residual_models.h"

namespace rlpc {

inline constexpr auto kResidualBound = static_cast<std::int32_t>(kMaxResidual);

}  // namespace rlpc
