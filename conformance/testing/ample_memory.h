// A limit of memory for tests in which it is not to be exceeded.
#pragma once

#include <cstdint>

namespace rlpc {

inline constexpr std::uint64_t kAmpleMemory = std::uint64_t{1} << 30;  // bytes

}  // namespace rlpc
