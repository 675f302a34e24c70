// The table of input formats. Each format is defined next to its reader and listed in
// open/input_formats.cpp.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/mesh_reader.h"

namespace rlpc {

struct InputFormat {
  enum class Holds : std::uint8_t {
    kAnimation,  // has open
    kMesh,       // one mesh: has parse
    kPoints,     // positions for the triangles of a mesh: has open_points
  };

  Holds holds;
  std::span<const std::string_view> extensions;  // lower case, ".obj"
  // Whether a file of this format may begin with these bytes, at most 64; null: the contents do
  // not show the format.
  bool (*begins)(std::string_view beginning) = nullptr;
  bool has_clips = false;  // InputOptions::animations and weld apply

  InputResult<std::unique_ptr<FrameSource>> (*open)(const InputOptions& options) = nullptr;
  // name: for error messages.
  InputResult<SingleMesh> (*parse)(std::string_view text, const std::string& name,
                                   const MeshLimit& limit) = nullptr;
  InputResult<std::unique_ptr<FrameSource>> (*open_points)(const InputOptions& options) =
      nullptr;
};

// Returns all formats, the most reliably recognised first.
std::span<const InputFormat* const> input_formats();

// Returns the format by the extension, otherwise by the contents; null: unknown.
const InputFormat* format_of(const std::string& path);
// Returns the format by the extension only; null: unknown.
const InputFormat* format_of_extension(const std::string& path);

// Returns ".obj, .off or .ply": the extensions of formats of these kinds.
std::string extensions_text(std::initializer_list<InputFormat::Holds> holds);
// Returns the extensions of all formats, a line for each kind, for help pages.
std::string formats_text();

// Returns an existing file next to `path` that differs only in its extension, one of a format
// of this kind; empty: none.
std::string sibling_of(const std::string& path, InputFormat::Holds holds);

}  // namespace rlpc
