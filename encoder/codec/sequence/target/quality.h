// Named qualities, and an estimate of whether an error is visible.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "encoder/codec/metrics/metrics.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Named qualities are KG errors, which are relative to the size of the mesh. Their
// area-weighted mean normal deviation on ten animations (characters, cloth and machines of 290
// to 3577 vertices), and the largest change in the shading of a matte surface, which is its
// sine:
//   preview            2.3 to 9.2 degrees; dents are visible, the motion is right
//   good               0.2 to 1.3 degrees; 2 % of full brightness, about the visible threshold
//   fine               0.07 to 0.38 degrees; 0.7 %
//   visually-lossless  0.02 to 0.13 degrees; 0.2 %, half a step of an 8-bit display
struct NamedQuality {
  const char* word;
  double kg_error_percent;
};
inline constexpr std::array<NamedQuality, 4> kQualities{
    // fixed: see above
    {{"preview", 1.0}, {"good", 0.1}, {"fine", 0.03}, {"visually-lossless", 0.01}}};
static_assert(Target{}.value == kQualities[1].kg_error_percent);  // the default is `good`

// An error relative to edge length: an error of e at one end of an edge of length l rotates a
// triangle by about e / l. On the animations above, an RMS error of 1 % of the median edge
// length causes a mean normal deviation of 0.2 to 0.65 degrees, so 3 % is about one degree.
struct Visibility {
  static constexpr double kVisiblePercent = 3.0;  // fixed: see above

  // Median length of edges that have not collapsed in the first frame, units.
  double median_edge = 0.0;
  double error_percent = 0.0;  // RMS error, in per cent of median_edge

  bool visible() const { return error_percent > kVisiblePercent; }
};

// Returns none if there are no edges, or none has a length. Errors: errors of the source.
InputResult<std::optional<Visibility>> measure_visibility(FrameSource& source,
                                                          const Metrics& metrics);

}  // namespace rlpc
