// Object of the functions that JavaScript calls: a SeekingDecoder behind a pointer, one per
// instance of the module. Memory that a function returns belongs to the object and is valid
// until the next call of that function.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "decoder/web/wasm/frame_surface.h"
#include "decoder/web/wasm/seeking_decoder.h"

#define RLPC_EXPORT(name) extern "C" [[clang::export_name(#name)]]

namespace rlpc {

// Decoder, and the last results computed for JavaScript.
struct Stream {
  explicit Stream(SeekingDecoder seeking) : decoder(std::move(seeking)) {}

  SeekingDecoder decoder;
  std::string text;
  std::vector<double> landmarks;
  std::vector<float> floats;
  std::vector<float> coordinates;
  std::vector<Vec3f> normals;
  std::vector<std::array<std::uint32_t, 2>> edges;
  FrameExtent extent;
  Vector<float> numbers;
  std::vector<Vec3f> set_normals;
};

}  // namespace rlpc
