// 6.10 Metadata, parsing side.
#pragma once

#include <string>

#include "common/bitstream/bit_reader.h"
#include "common/result.h"

namespace rlpc {

// The JSON text, inflated; at most kMaxMetadataBytes.
Result<std::string> parse_metadata(BitReader& r);

}  // namespace rlpc
