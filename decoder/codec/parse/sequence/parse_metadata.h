// 6.10 Metadata, parsing side.
#pragma once

#include "common/codec/bits/bit_reader.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/parse/memory_limit.h"

namespace rlpc {

// 6.10 metadata( ). Returns the JSON text, inflated; at most kMaxMetadataBytes.
Result<String> parse_metadata(BitReader& r, const MemoryLimit& memory);

}  // namespace rlpc
