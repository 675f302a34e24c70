// zlib streams within payloads (4.5).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/memory/owned.h"

namespace rlpc {

// inflates_to( ): inflates exactly one zlib stream; none unless it yields `size` bytes.
// Allocates size + 1 bytes.
std::optional<String> inflate_exactly(std::span<const std::uint8_t> deflated,
                                      std::uint32_t size);

}  // namespace rlpc
