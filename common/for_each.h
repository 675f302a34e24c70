// How a loop over independent passes is run: perhaps on several threads, which the code of this
// side does not know. Integers do not depend on it.
#pragma once

#include <cstddef>
#include <functional>

namespace rlpc {

// Calls pass(i) for all i < count, in any order, and returns once all are done.
using ForEach =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& pass)>;

inline void in_order(std::size_t count, const std::function<void(std::size_t)>& pass) {
  for (std::size_t i = 0; i < count; ++i) pass(i);
}

}  // namespace rlpc
