// 6.16 Asset, parsing side.
#pragma once

#include "common/codec/bits/bit_reader.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/parse/memory_limit.h"

namespace rlpc {

// 6.16 asset( ). Inflates an asset of asset_format 0; empty for other formats. Fails if it
// needs more memory than is allowed.
Result<String> parse_asset(BitReader& r, const MemoryLimit& memory);

}  // namespace rlpc
