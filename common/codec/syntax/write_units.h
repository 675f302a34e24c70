// 6.1, 6.2 and 6.7 to 6.9, writing side, shared by the encoder and the sub-stream extractor.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/syntax/stream_format.h"
#include "common/memory/owned.h"

namespace rlpc {

using Bytes = Vector<std::uint8_t>;

// Writes signature and version; the version is that of the profile.
Bytes write_stream_header(std::uint32_t profile_idc);
// Writes a unit: the payload with its header and CRC.
Bytes write_unit(UnitType type, const Bytes& payload);
// The functions below return payloads.
Bytes write_gof_hash(std::span<const std::uint32_t> position_crc, bool per_frame);

struct GofEntry {
  std::uint32_t num_frames;
  std::uint64_t bytes;  // bytes from its GOF unit to the next one
};
// Index entry of a rig unit.
struct RigIndexEntry {
  std::uint32_t rig_idx;
  std::uint64_t offset;  // bytes from the start of the stream, ascending
};
struct GofIndexEntries {
  std::uint64_t first_gof_offset = 0;
  Vector<GofEntry> gofs;
  Vector<RigIndexEntry> rigs;

  // R-IDX-02: returns whether all distances can be written.
  bool fits() const;
};
Bytes write_gof_index(const GofIndexEntries& index, std::uint32_t profile_idc);
// num_frames: frames of the sequence, written only in an open-ended stream.
Bytes write_end_of_sequence(std::uint32_t index_distance,
                            std::optional<std::uint32_t> num_frames = std::nullopt);

}  // namespace rlpc
