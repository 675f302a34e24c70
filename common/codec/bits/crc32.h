// CRC-32 of clause 9.7 (polynomial 0x04C11DB7, reflected, as in zlib and PNG).
#pragma once

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace rlpc {

// Continues `crc` over more bytes; starts from 0.
inline std::uint32_t crc32_of(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0) {
  return static_cast<std::uint32_t>(crc32_z(crc, bytes.data(), bytes.size()));
}

// 9.7.2 Hash of positions: the CRC of their bytes, 32 bits each, least significant byte first.
inline std::uint32_t crc32_of_positions(std::span<const std::int32_t> positions,
                                        std::uint32_t crc = 0) {
  std::array<std::uint8_t, 4096> block{};
  while (!positions.empty()) {
    const std::size_t count = std::min(positions.size(), block.size() / 4);
    for (std::size_t i = 0; i < count; ++i) {
      const auto x = static_cast<std::uint32_t>(positions[i]);
      for (std::size_t b = 0; b < 4; ++b) {
        block[4 * i + b] = static_cast<std::uint8_t>(x >> (8 * b));
      }
    }
    crc = crc32_of(std::span<const std::uint8_t>(block).first(4 * count), crc);
    positions = positions.subspan(count);
  }
  return crc;
}

}  // namespace rlpc
