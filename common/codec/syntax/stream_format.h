// Outer layer of a stream (clauses 6.1 and 6.2): signature, version and unit types.
#pragma once

#include <array>
#include <cstdint>

#include "common/result.h"

namespace rlpc {

// 6.1: the first byte is not text, and the line ends reveal transfers that convert them.
inline constexpr std::array<std::uint8_t, 8> kSignature{0x89, 'R',  'L',  'P',
                                                        'C',  0x0D, 0x0A, 0x1A};

inline constexpr std::uint32_t kVersionMajor = 1;
inline constexpr std::uint32_t kVersionMinor = 2;  // newest supported version

inline constexpr std::size_t kStreamHeaderBytes = 10;  // signature and version
inline constexpr std::size_t kUnitHeaderBytes = 5;     // ancillary_flag, unit_type, unit_size
inline constexpr std::size_t kUnitCrcBytes = 4;

// Table 7-1. The upper bit of the first byte of a unit is ancillary_flag.
enum class UnitType : std::uint8_t {
  kSequenceHeader = 0x01,
  kConnectivity = 0x02,
  kVertexOrder = 0x03,
  kGof = 0x04,
  kEndOfSequence = 0x05,
  kSlice = 0x06,
  kRig = 0x07,
  kFrame = 0x08,
  kGofIndex = 0x81,
  kGofHash = 0x82,
  kMetadata = 0x83,
  kAttributes = 0x88,
  kAsset = 0x89,
  kClipTable = 0x8A,
};

// Returns whether units of a type belong to the GOF or rig unit before them.
constexpr bool is_slice_type(UnitType type) {
  return type == UnitType::kSlice || type == UnitType::kFrame;
}

// 6.2 IsKnownType( type ), for critical units.
constexpr bool is_known_type(UnitType type, std::uint32_t version_minor) {
  constexpr std::array<UnitType, 3> kLast{UnitType::kEndOfSequence, UnitType::kSlice,
                                          UnitType::kFrame};
  return type >= UnitType::kSequenceHeader &&
         type <= kLast[version_minor < 2 ? version_minor : 2];
}

// Returns whether a decoder of this version may read an ancillary unit.
constexpr bool is_known_ancillary(UnitType type) {
  return type == UnitType::kGofIndex || type == UnitType::kGofHash ||
         type == UnitType::kMetadata || type == UnitType::kClipTable ||
         type == UnitType::kAttributes || type == UnitType::kAsset;
}

inline constexpr std::uint8_t kAncillaryFlag = 0x80;

// R-STR-03: returns the error of a minor version that is unknown or does not match the profile.
inline Error unsupported_minor_version() {
  return {Errc::kUnsupported, "R-STR-03", "version_minor", 72};
}

}  // namespace rlpc
