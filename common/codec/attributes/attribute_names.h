// Names of attribute sets that have a meaning (Table F-1).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rlpc {

inline constexpr const char* kNormalName = "normal";      // unit normals, or smoothing
inline constexpr const char* kMaterialName = "material";  // index of the material of a triangle
inline constexpr const char* kPartName = "part";          // index of the part of a triangle
// Beginnings of names that end with a number from 0 on.
inline constexpr const char* kUvPrefix = "uv";          // texture coordinates
inline constexpr const char* kColourPrefix = "colour";  // linear red, green, blue, opacity

// Returns the name of set `number` of texture coordinates, or of colours.
inline std::string uv_name(std::uint32_t number) { return kUvPrefix + std::to_string(number); }
inline std::string colour_name(std::uint32_t number) {
  return kColourPrefix + std::to_string(number);
}

// Returns the number of a name that is the prefix and a number; none if it is something else.
inline std::optional<std::uint32_t> number_after(std::string_view prefix,
                                                 std::string_view name) {
  constexpr std::uint32_t kMax = 255;  // sets are numbered from 0 on without gaps
  if (!name.starts_with(prefix)) return std::nullopt;
  for (std::uint32_t n = 0; n <= kMax; ++n) {
    if (name.substr(prefix.size()) == std::to_string(n)) return n;
  }
  return std::nullopt;
}

}  // namespace rlpc
