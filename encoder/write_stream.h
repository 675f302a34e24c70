// 6.1 to 6.3 and 6.6 to 6.9, writing side: everything around the GOFs.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "common/sequence_header.h"
#include "common/stream_format.h"

namespace rlpc {

using Bytes = std::vector<std::uint8_t>;

Bytes write_stream_header();
// A payload with its header and CRC.
Bytes write_unit(UnitType type, const Bytes& payload);
// The rest are payloads.
Bytes write_sequence_header(const SequenceHeader& header);
Bytes write_vertex_order(std::span<const std::uint32_t> output_vertex);
Bytes write_gof_hash(std::span<const std::uint32_t> position_crc, bool per_frame);
Bytes write_metadata(std::string_view json);

struct GofEntry {
  std::uint32_t num_frames;
  std::uint64_t bytes;  // from its unit to that of the next GOF
};
Bytes write_gof_index(std::uint64_t first_gof_offset, std::span<const GofEntry> gofs);
Bytes write_end_of_sequence(std::uint32_t index_distance);

}  // namespace rlpc
