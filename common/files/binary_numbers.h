// Reads and writes 32-bit numbers of binary files: little-endian, or big-endian with _be.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace rlpc {

inline void append_u32(std::string& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>((value >> shift) & 0xFF);
  }
}
inline void append_i32(std::string& bytes, std::int32_t value) {
  append_u32(bytes, static_cast<std::uint32_t>(value));
}
inline void append_f32(std::string& bytes, float value) {
  append_u32(bytes, std::bit_cast<std::uint32_t>(value));
}
inline void append_u32_be(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes += static_cast<char>((value >> shift) & 0xFF);
  }
}
inline void append_f32_be(std::string& bytes, float value) {
  append_u32_be(bytes, std::bit_cast<std::uint32_t>(value));
}

// Load numbers. The caller must have checked the length.
inline std::uint32_t load_u32(std::span<const char> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) {
    value = (value << 8) | static_cast<unsigned char>(bytes[offset + i]);
  }
  return value;
}
inline std::int32_t load_i32(std::span<const char> bytes, std::size_t offset) {
  return static_cast<std::int32_t>(load_u32(bytes, offset));
}
inline float load_f32(std::span<const char> bytes, std::size_t offset) {
  return std::bit_cast<float>(load_u32(bytes, offset));
}
inline std::uint32_t load_u32_be(std::span<const char> bytes, std::size_t offset) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = (value << 8) | static_cast<unsigned char>(bytes[offset + i]);
  }
  return value;
}
inline float load_f32_be(std::span<const char> bytes, std::size_t offset) {
  return std::bit_cast<float>(load_u32_be(bytes, offset));
}

}  // namespace rlpc
