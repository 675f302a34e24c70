// Memory limit of the caller (DecodeLimits).
#pragma once

#include <cstdint>

namespace rlpc {

struct MemoryLimit {
  std::uint64_t max_bytes = 0;
  std::uint64_t bytes_in_use = 0;  // memory of the rest of the decoder
};

}  // namespace rlpc
