#include "conformance/rlpcval/validator_units.h"

#include <algorithm>
#include <array>
#include <string>

#include "common/codec/bits/crc32.h"
#include "common/codec/syntax/stream_format.h"

namespace rlpc {
namespace {

// Bytes that searches for units may read, in lengths of the stream.
constexpr std::uint64_t kSearchesOfStream = 64;

std::uint32_t big_endian(const std::uint8_t* b) {
  return (std::uint32_t{b[0]} << 24) | (std::uint32_t{b[1]} << 16) |
         (std::uint32_t{b[2]} << 8) | b[3];
}

std::uint32_t swapped(std::uint32_t x) {
  return x >> 24 | (x >> 8 & 0xFF00) | (x << 8 & 0xFF0000) | x << 24;
}

std::string describe_signature(const std::array<std::uint8_t, kStreamHeaderBytes>& bytes) {
  if (std::equal(kSignature.begin() + 1, kSignature.begin() + 5, bytes.begin() + 1)) {
    return "the name is right, but not the bytes around it: a text-mode transfer changed them";
  }
  return "the file begins with another signature";
}

}  // namespace

// Table 7-1. Any ancillary type may occur in a stream.
bool StreamUnits::possible_type(std::uint8_t type_byte) const {
  return known_type(UnitType{type_byte});
}

bool StreamUnits::known_type(UnitType type) const {
  const auto code = static_cast<std::uint8_t>(type);
  return (code & kAncillaryFlag) != 0 || is_known_type(type, version_minor_);
}

bool StreamUnits::read(std::uint64_t offset, std::span<std::uint8_t> out, const char* element) {
  if (failed_) return false;
  if (source_.read(offset, out)) return true;
  failed_ = true;
  findings_.error({Errc::kIo, "", element, offset * 8});
  return false;
}

// 6.1 stream( )
bool StreamUnits::stream_header() {
  std::array<std::uint8_t, kStreamHeaderBytes> bytes{};
  const auto present = static_cast<std::size_t>(std::min<std::uint64_t>(size(), bytes.size()));
  if (!read(0, std::span(bytes).first(present), "signature")) return false;
  version_minor_ = bytes[9];
  const std::size_t comparable = std::min(present, kSignature.size());
  if (!std::equal(kSignature.begin(), kSignature.begin() + comparable, bytes.begin())) {
    findings_.error({Errc::kInvalid, "R-STR-01", "signature", 0}, describe_signature(bytes));
    return is_unit(kStreamHeaderBytes);
  }
  if (present < bytes.size()) {
    findings_.error({Errc::kTruncated, "R-BIT-01", "signature", present * 8},
                    "the file has " + std::to_string(present) + " bytes");
    return false;
  }
  const std::string version = "the stream is of version " + std::to_string(bytes[8]) + "." +
                              std::to_string(bytes[9]) + ", this is a validator of " +
                              std::to_string(kVersionMajor) + "." +
                              std::to_string(kVersionMinor);
  if (bytes[8] != kVersionMajor) {
    findings_.error({Errc::kUnsupported, "R-STR-02", "version_major", 64}, version);
    return false;
  }
  if (bytes[9] > kVersionMinor) {
    findings_.error({Errc::kUnsupported, "R-STR-03", "version_minor", 72}, version);
  } else if (bytes[9] == 2 && size() == bytes.size()) {
    findings_.error({Errc::kUnsupported, "R-STR-03", "version_minor", 72},
                    "a stream of version 1.2 does not end after its version");
  }
  return true;
}

// 6.2 unit_header( )
std::optional<UnitHeader> StreamUnits::header_at(std::uint64_t offset) {
  std::array<std::uint8_t, kUnitHeaderBytes> bytes{};
  if (offset + bytes.size() > size()) {
    findings_.error({Errc::kTruncated, "R-UNT-01", "unit_type", offset * 8},
                    std::to_string(size() - std::min(size(), offset)) +
                        " bytes are left where a unit has to follow");
    return std::nullopt;
  }
  if (!read(offset, bytes, "unit_type")) return std::nullopt;
  const UnitHeader unit{bytes[0], big_endian(&bytes[1]), offset};
  if (!unit.ancillary() && unit.size > max_unit_bytes_) {
    findings_.error({Errc::kInvalid, "R-LVL-07", "unit_size", offset * 8 + 8},
                    "unit_size is " + std::to_string(unit.size) + "; the level allows " +
                        std::to_string(max_unit_bytes_));
  }
  if (unit.end() > size()) {
    const UnitHeader other{bytes[0], swapped(unit.size), offset};
    const bool other_order = other.end() <= size();
    findings_.error({Errc::kTruncated, "R-UNT-02", "unit_size", offset * 8 + 8},
                    "unit_size is " + std::to_string(unit.size) +
                        ", which with unit_crc ends " + std::to_string(unit.end() - size()) +
                        " bytes past the stream" +
                        (other_order ? "; in the other byte order, it would fit" : ""));
    return std::nullopt;
  }
  return unit;
}

bool StreamUnits::crc_of_unit(const UnitHeader& unit, std::uint32_t& stored,
                              std::uint32_t& computed) {
  std::array<std::uint8_t, std::size_t{1} << 16> block{};
  const std::uint64_t crc_at = unit.end() - kUnitCrcBytes;
  computed = 0;
  for (std::uint64_t at = unit.offset; at < crc_at;) {
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(crc_at - at, block.size()));
    const auto bytes = std::span(block).first(count);
    if (!read(at, bytes, "unit_payload")) return false;
    computed = crc32_of(bytes, computed);
    at += count;
  }
  std::array<std::uint8_t, kUnitCrcBytes> crc{};
  if (!read(crc_at, crc, "unit_crc")) return false;
  stored = big_endian(crc.data());
  return true;
}

// 6.2 unit_body( )
bool StreamUnits::crc_holds(const UnitHeader& unit) {
  std::uint32_t stored = 0;
  std::uint32_t computed = 0;
  if (!crc_of_unit(unit, stored, computed)) return false;
  if (stored == computed) return true;
  findings_.error(
      {Errc::kInvalid, "R-UNT-03", "unit_crc", (unit.end() - kUnitCrcBytes) * 8},
      "unit_crc is " + hex(stored) + ", the bytes of the unit give " + hex(computed) +
          (stored == swapped(computed) ? ": its bytes are in the other order" : ""));
  return false;
}

std::optional<std::vector<std::uint8_t>> StreamUnits::payload(const UnitHeader& unit) {
  if (unit.size > max_memory_bytes_) {
    findings_.error({Errc::kLimitExceeded, "", "unit_size", unit.offset * 8 + 8});
    return std::nullopt;
  }
  std::vector<std::uint8_t> bytes(unit.size);
  if (!read(unit.payload_offset(), bytes, "unit_payload")) return std::nullopt;
  return bytes;
}

// Finds chains from the end backwards: a chain is an end_of_sequence unit at the very end, or a
// unit of a possible type after which a chain begins.
bool StreamUnits::find_chains(std::uint64_t offset) {
  if (chains_from_ && *chains_from_ <= offset) return true;
  offset = std::min(offset, size());
  if (size() - offset > max_memory_bytes_ / 9 * 8) return false;
  const auto count = static_cast<std::size_t>(size() - offset);
  std::vector<std::uint8_t> bytes(count);
  if (!read(offset, bytes, "unit_payload")) return false;
  chain_.assign(count, false);
  chains_from_ = offset;
  for (std::size_t i = count; i-- > 0;) {
    if (count - i < kUnitHeaderBytes + kUnitCrcBytes || !possible_type(bytes[i])) continue;
    const UnitHeader unit{bytes[i], big_endian(&bytes[i + 1]), offset + i};
    const bool last = unit.end() == size() && unit.type() == UnitType::kEndOfSequence;
    chain_[i] = last || (unit.end() < size() && in_chain(unit.end()));
  }
  return true;
}

bool StreamUnits::in_chain(std::uint64_t offset) const {
  return chain_[static_cast<std::size_t>(offset - *chains_from_)];
}

bool StreamUnits::begins_chain(std::uint64_t offset) {
  return offset < size() && find_chains(offset) && in_chain(offset);
}

std::optional<std::uint64_t> StreamUnits::next_chain(std::uint64_t offset) {
  if (searched_from_ && *searched_from_ <= offset && (!found_ || offset <= *found_)) {
    return found_;
  }
  if (!find_chains(offset)) return std::nullopt;
  // A stream made for it could have a candidate in every byte, each as long as the stream.
  const std::uint64_t budget = kSearchesOfStream * size();
  searched_from_ = offset;
  found_.reset();
  for (std::uint64_t at = offset; at < size() && searched_bytes_ <= budget && !found_; ++at) {
    if (!in_chain(at)) continue;
    if (is_unit(at)) found_ = at;
    searched_bytes_ += size() - at;
  }
  return found_;
}

bool StreamUnits::is_unit(std::uint64_t offset) {
  std::array<std::uint8_t, kUnitHeaderBytes> bytes{};
  if (offset + bytes.size() > size() || !read(offset, bytes, "unit_type")) return false;
  const UnitHeader unit{bytes[0], big_endian(&bytes[1]), offset};
  std::uint32_t stored = 0;
  std::uint32_t computed = 0;
  return possible_type(unit.type_byte) && unit.end() <= size() &&
         crc_of_unit(unit, stored, computed) && stored == computed;
}

}  // namespace rlpc
