// The header of a PLY file: text that declares the contents and their format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/meshes/frame_source.h"

namespace rlpc {

enum class PlyEncoding : std::uint8_t { kText, kLittleEndian, kBigEndian };
enum class PlyType : std::uint8_t { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

std::size_t ply_bytes(PlyType type);
bool is_ply_float(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kF32;
  std::optional<PlyType> length;  // lists only: the integer type of the length
};

struct PlyElement {
  std::string name;
  std::uint32_t count = 0;
  std::vector<PlyProperty> properties;  // at least one if there is an element
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  std::vector<PlyElement> elements;     // in the order of the file
  std::optional<FrameRate> frame_rate;  // "comment frame_rate N/D"
  std::vector<std::string> textures;    // "comment TextureFile NAME"
  bool has_info = false;                // there are lines "obj_info"
  std::size_t body = 0;                 // offset of the first byte after the header
  std::uint64_t body_line = 0;          // number of the line that begins there
};

// name: for error messages.
InputResult<PlyHeader> parse_ply_header(std::string_view text, const std::string& name);

}  // namespace rlpc
