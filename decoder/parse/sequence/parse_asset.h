// 6.16 Asset, parsing side.
#pragma once

#include <string>

#include "common/bitstream/bit_reader.h"
#include "common/result.h"
#include "decoder/parse/memory_limit.h"

namespace rlpc {

// The bytes of an asset of asset_format 0, inflated; empty for other formats. Fails if they
// need more memory than is allowed.
Result<std::string> parse_asset(BitReader& r, const MemoryLimit& memory);

}  // namespace rlpc
