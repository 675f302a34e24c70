#include "decoder/codec/units/unit_reader.h"

#include <algorithm>
#include <array>

#include "common/codec/bits/crc32.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

std::uint32_t big_endian(std::span<const std::uint8_t> b) {
  return (std::uint32_t{b[0]} << 24) | (std::uint32_t{b[1]} << 16) |
         (std::uint32_t{b[2]} << 8) | b[3];
}

}  // namespace

// 6.1 stream( )
Result<bool> UnitReader::stream_header() {
  std::array<std::uint8_t, kStreamHeaderBytes> bytes{};
  const bool is_whole = source_->reaches(bytes.size());
  const auto present =
      is_whole
          ? bytes.size()
          : static_cast<std::size_t>(std::min<std::uint64_t>(source_->size(), bytes.size()));
  if (!source_->read(0, std::span(bytes).first(present))) {
    return Error{Errc::kIo, "", "signature", 0};
  }
  const auto differs =
      std::mismatch(kSignature.begin(), kSignature.end(), bytes.begin()).first -
      kSignature.begin();
  if (static_cast<std::uint64_t>(differs) <
      std::min<std::uint64_t>(present, kSignature.size())) {
    return Error{Errc::kInvalid, "R-STR-01", "signature", 0};
  }
  if (present < bytes.size())
    return Error{Errc::kTruncated, "R-BIT-01", "signature", present * 8};
  if (trace_ != nullptr) {
    trace_->begin("stream", 0);
    trace_->element("version_major", bytes[8], 64);
    trace_->element("version_minor", bytes[9], 72);
  }
  if (bytes[8] != kVersionMajor)
    return Error{Errc::kUnsupported, "R-STR-02", "version_major", 64};
  // Version 1.1 reported streams that end after the number of version 1.2 as unsupported.
  const bool ends_here = bytes[9] == 2 && !source_->reaches(bytes.size() + 1);
  if (bytes[9] > kVersionMinor || ends_here) return unsupported_minor_version();
  version_minor_ = bytes[9];
  return true;
}

// 6.2 unit_header( )
Result<UnitHeader> UnitReader::header_at(std::uint64_t offset) {
  std::array<std::uint8_t, kUnitHeaderBytes> bytes{};
  if (!source_->reaches(offset + bytes.size())) {
    return Error{Errc::kTruncated, "R-UNT-01", "unit_type", offset * 8};
  }
  if (!source_->read(offset, bytes)) return Error{Errc::kIo, "", "unit_type", offset * 8};
  UnitHeader unit{bytes[0], big_endian(std::span(bytes).subspan(1)), offset};
  if (!unit.ancillary() && unit.size > max_unit_bytes_) {
    return Error{Errc::kInvalid, "R-LVL-07", "unit_size", offset * 8 + 8};
  }
  if (!source_->reaches(unit.end())) {
    return Error{Errc::kTruncated, "R-UNT-02", "unit_size", offset * 8 + 8};
  }
  return unit;
}

void UnitReader::flush_trace() {
  if (trace_ != nullptr && pending_crc_) {
    trace_->element("unit_crc", pending_crc_->value, pending_crc_->bit_pos);
  }
  pending_crc_.reset();
}

void UnitReader::trace_header(const UnitHeader& unit) {
  flush_trace();
  if (trace_ == nullptr) return;
  const std::uint64_t at = unit.offset * 8;
  trace_->begin("unit", at);
  trace_->element("ancillary_flag", unit.ancillary() ? 1 : 0, at);
  trace_->element("unit_type", unit.type_byte & 0x7F, at + 1);
  trace_->element("unit_size", unit.size, at + 8);
}

Result<bool> UnitReader::check_crc(const UnitHeader& unit, std::uint32_t computed,
                                   std::uint32_t unit_crc) {
  const std::uint64_t at = (unit.end() - kUnitCrcBytes) * 8;
  if (computed != unit_crc) return Error{Errc::kInvalid, "R-UNT-03", "unit_crc", at};
  pending_crc_ = PendingCrc{computed, at};
  return true;
}

Result<Vector<std::uint8_t>> UnitReader::payload(const UnitHeader& unit) {
  const std::uint64_t needed_bytes =
      memory_.bytes_in_use + unit.size + source_->memory_bytes() - bytes_at_first_;
  if (needed_bytes > memory_.max_bytes || std::uint64_t{unit.size} > kMaxPayloadBytes) {
    return Error{Errc::kLimitExceeded, "", "unit_size", unit.offset * 8 + 8, needed_bytes};
  }
  trace_header(unit);
  Vector<std::uint8_t> bytes(kUnitHeaderBytes + std::size_t{unit.size} + kUnitCrcBytes);
  if (!source_->read(unit.offset, bytes)) {
    return Error{Errc::kIo, "", "unit_payload", unit.payload_offset() * 8};
  }
  const std::span<const std::uint8_t> covered(bytes.data(), bytes.size() - kUnitCrcBytes);
  const std::uint32_t unit_crc = big_endian(std::span(bytes).last(kUnitCrcBytes));
  if (const auto ok = check_crc(unit, crc32_of(covered), unit_crc); !ok) return ok.error();
  bytes.resize(bytes.size() - kUnitCrcBytes);
  bytes.erase(bytes.begin(), bytes.begin() + kUnitHeaderBytes);
  return bytes;
}

Result<bool> UnitReader::skip(const UnitHeader& unit) {
  trace_header(unit);
  std::array<std::uint8_t, 4096> block{};
  std::uint32_t crc = 0;
  std::uint64_t at = unit.offset;
  const std::uint64_t covered_end = unit.end() - kUnitCrcBytes;
  while (at < covered_end) {
    const auto part = std::span(block).first(
        static_cast<std::size_t>(std::min<std::uint64_t>(covered_end - at, block.size())));
    if (!source_->read(at, part)) return Error{Errc::kIo, "", "unit_payload", at * 8};
    crc = crc32_of(part, crc);
    at += part.size();
  }
  const auto stored = std::span(block).first(kUnitCrcBytes);
  if (!source_->read(at, stored)) return Error{Errc::kIo, "", "unit_crc", at * 8};
  return check_crc(unit, crc, big_endian(stored));
}

Result<Vector<std::uint8_t>> UnitReader::payload_start(const UnitHeader& unit,
                                                       std::uint32_t max_bytes) {
  Vector<std::uint8_t> bytes(std::min(unit.size, max_bytes));
  if (!source_->read(unit.payload_offset(), bytes)) {
    return Error{Errc::kIo, "", "unit_payload", unit.payload_offset() * 8};
  }
  return bytes;
}

}  // namespace rlpc
