// The memory that the caller allows (DecodeLimits).
#pragma once

#include <cstdint>

namespace rlpc {

struct MemoryLimit {
  std::uint64_t max_bytes = 0;
  std::uint64_t bytes_in_use = 0;  // by others, while something is read or parsed
};

}  // namespace rlpc
