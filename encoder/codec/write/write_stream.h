// 6.3, 6.6, 6.10 and 6.15, writing side. Together with common/codec/syntax/write_units.h, these
// are all units except GOFs, slices and connectivity.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/codec/mesh/clip.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/codec/syntax/write_units.h"

namespace rlpc {

// Return the payload of a unit.
Bytes write_sequence_header(const SequenceHeader& header);
Bytes write_vertex_order(std::span<const std::uint32_t> output_vertex);
Bytes write_metadata(std::string_view json);
// 6.16 asset( ), of a GLB.
Bytes write_asset(std::string_view glb);
// At least one clip, and at most kMaxClips.
Bytes write_clip_table(std::span<const Clip> clips);

}  // namespace rlpc
