// Settings for the coding of attributes.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/meshes/source_attribute.h"

namespace rlpc {

// kSmoothing: decoders compute normals from the positions of each frame (F.8). kExact: normals
// of the first frame. kAuto: smoothing if it comes near enough to the normals of the input.
enum class NormalChoice : std::uint8_t { kAuto, kSmoothing, kExact };

struct AttributeSettings {
  bool dropped = false;  // no attribute unit
  // Numbers are coded as 32-bit floats and normals with 16 bits per coordinate, regardless of
  // the bits below. Normals are coded as smoothing only if that is chosen.
  bool exact = false;
  // Fraction bits of a texture coordinate: 12 are 1/4096 of an image. Where coordinates repeat
  // an image of a known size, the minimum number of bits over their range.
  int uv_bits = 12;            // 1 to 16
  std::vector<UvUse> uv_uses;  // [number of a set of texture coordinates]; absent: {}
  // Bits of a coordinate of a unit vector, 2 to 16. At 8, q-spider's normals take 3.8 kB and
  // are off by 0.33 degrees RMS, 0.6 at most; at 7, 2.9 kB and twice that; at 10, 6.2 kB and a
  // quarter.
  int normal_bits = 8;
  int number_bits = 12;  // bits of other numbers over their range, 1 to 16
  NormalChoice normals = NormalChoice::kAuto;
  // Whether values may be predicted from positions of the first frame; not allowed in streams
  // that are to be cut.
  bool from_positions = true;
};

}  // namespace rlpc
