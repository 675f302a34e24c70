// Finds units (6.2), reads them, and checks their CRC.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/bits/trace.h"
#include "common/codec/syntax/stream_format.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/units/byte_source.h"

namespace rlpc {

struct UnitHeader {
  std::uint8_t type_byte = 0;  // ancillary_flag and unit_type
  std::uint32_t size = 0;      // payload bytes
  std::uint64_t offset = 0;    // bytes from the start of the stream to the unit

  UnitType type() const { return static_cast<UnitType>(type_byte); }
  bool ancillary() const { return (type_byte & kAncillaryFlag) != 0; }
  std::uint64_t payload_offset() const { return offset + kUnitHeaderBytes; }
  std::uint64_t end() const { return payload_offset() + size + kUnitCrcBytes; }
};

class UnitReader {
 public:
  // max_memory_bytes: limit of a payload together with the bytes in use.
  explicit UnitReader(std::unique_ptr<ByteSource> source, Trace* trace = nullptr,
                      std::uint64_t max_memory_bytes = kMaxPayloadBytes)
      : source_(std::move(source)),
        trace_(trace),
        memory_{max_memory_bytes, 0},
        bytes_at_first_(source_->memory_bytes()) {}

  // 6.1: reads signature and version.
  Result<bool> stream_header();
  // Sets the maximum payload of critical units from now on: MaxUnitBytes of Annex B.
  void set_max_unit_bytes(std::uint64_t bytes) { max_unit_bytes_ = bytes; }
  // Reads the header of the unit at a byte offset, and checks that the unit ends within the
  // stream.
  Result<UnitHeader> header_at(std::uint64_t offset);
  // Sets the memory that the rest of the decoder uses from now on.
  void set_bytes_in_use(std::uint64_t bytes) { memory_.bytes_in_use = bytes; }
  // Reads the payload of a unit and checks its CRC.
  Result<Vector<std::uint8_t>> payload(const UnitHeader& unit);
  // Skips a unit and checks its CRC. Allocates nothing.
  Result<bool> skip(const UnitHeader& unit);
  // Reads up to max_bytes from the beginning of a payload, without checking the CRC.
  Result<Vector<std::uint8_t>> payload_start(const UnitHeader& unit, std::uint32_t max_bytes);
  // Returns a reader of a payload, with positions from the start of the stream.
  BitReader bits(const UnitHeader& unit, const Vector<std::uint8_t>& payload) const {
    return BitReader(payload, unit.payload_offset() * 8, trace_);
  }

  // Traces the unit_crc of the last payload, after the elements of the payload.
  void flush_trace();

  std::uint32_t version_minor() const { return version_minor_; }
  // Returns the size of the stream in bytes. Reads a pipe to its end.
  std::uint64_t size() const { return source_->size(); }
  // Returns whether the stream continues after its first `end` bytes. Waits for a pipe.
  bool goes_on_after(std::uint64_t end) const { return source_->reaches(end + 1); }
  void forget(std::uint64_t before) { source_->forget(before); }

 private:
  // Largest payload that a vector can hold with header and CRC, also on 32-bit machines.
  static constexpr std::uint64_t kMaxPayloadBytes =
      std::uint64_t{std::numeric_limits<std::ptrdiff_t>::max()} - kUnitHeaderBytes -
      kUnitCrcBytes;

  void trace_header(const UnitHeader& unit);
  // Compares a computed CRC with unit_crc of the stream.
  Result<bool> check_crc(const UnitHeader& unit, std::uint32_t computed,
                         std::uint32_t unit_crc);

  struct PendingCrc {
    std::uint32_t value;
    std::uint64_t bit_pos;
  };

  std::unique_ptr<ByteSource> source_;
  Trace* trace_;
  MemoryLimit memory_;
  std::uint64_t bytes_at_first_;  // held by the source, accounted for by the caller
  std::uint32_t version_minor_ = 0;
  std::uint64_t max_unit_bytes_ = 0xFFFFFFFF;
  std::optional<PendingCrc> pending_crc_;
};

}  // namespace rlpc
