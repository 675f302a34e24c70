// Quality in words, and whether an error can be seen.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "encoder/rlpc_encoder.h"

namespace rlpc {

// KG errors, as these are relative to the size of the mesh. Over ten animations of 290 to 3577
// vertices, characters, cloth and machines (mean by area of the angle between normals before
// and after; what it changes in the shading of a matte surface, at most, is its sine):
//   preview            2.3 to 9.2 degrees: dents are seen, motion is right
//   good               0.2 to 1.3 degrees: 2 % of full light, about what eyes tell apart
//   fine               0.07 to 0.38 degrees: 0.7 %
//   visually-lossless  0.02 to 0.13 degrees: 0.2 %, half a step of a display of 8 bits
struct NamedQuality {
  const char* word;
  double kg_error_percent;
};
inline constexpr std::array<NamedQuality, 4> kQualities{
    // fixed: see above
    {{"preview", 1.0}, {"good", 0.1}, {"fine", 0.03}, {"visually-lossless", 0.01}}};
static_assert(Target{}.value == kQualities[1].kg_error_percent);  // the default is `good`

// An error beside the length of edges: one of e across an edge of length l turns the triangle
// by about e / l. On the animations above, an RMS error of 1 % of the median edge turned
// triangles by 0.2 to 0.65 degrees in the mean, so that 3 % are about one degree.
struct Visibility {
  static constexpr double kVisiblePercent = 3.0;  // fixed: see above

  double median_edge = 0.0;    // of the first frame, in units
  double error_percent = 0.0;  // RMS, of median_edge

  bool visible() const { return error_percent > kVisiblePercent; }
};

// None where there are no edges, or most have length 0.
InputResult<std::optional<Visibility>> measure_visibility(FrameSource& source,
                                                          const Metrics& metrics);

}  // namespace rlpc
