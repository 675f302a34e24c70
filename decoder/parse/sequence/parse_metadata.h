// 6.10 Metadata, parsing side.
#pragma once

#include "common/bitstream/bit_reader.h"
#include "common/owned.h"
#include "common/result.h"
#include "decoder/parse/memory_limit.h"

namespace rlpc {

// The JSON text, inflated; at most kMaxMetadataBytes.
Result<String> parse_metadata(BitReader& r, const MemoryLimit& memory);

}  // namespace rlpc
