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

// Each returns the payload of a unit.
Bytes write_sequence_header(const SequenceHeader& header);
Bytes write_vertex_order(std::span<const std::uint32_t> output_vertex);
Bytes write_metadata(std::string_view json);
// At least one clip, and at most kMaxClips.
// 6.16 asset( ), of a GLB.
Bytes write_asset(std::string_view glb);
Bytes write_clip_table(std::span<const Clip> clips);

}  // namespace rlpc
