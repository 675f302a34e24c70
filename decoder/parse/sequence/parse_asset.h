// 6.16 Asset, parsing side.
#pragma once

#include "common/bitstream/bit_reader.h"
#include "common/owned.h"
#include "common/result.h"
#include "decoder/parse/memory_limit.h"

namespace rlpc {

// The bytes of an asset of asset_format 0, inflated; empty for other formats. Fails if they
// need more memory than is allowed.
Result<String> parse_asset(BitReader& r, const MemoryLimit& memory);

}  // namespace rlpc
