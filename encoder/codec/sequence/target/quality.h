// Named qualities, and an estimate of whether an error is visible.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "encoder/codec/metrics/metrics.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Named qualities bound what is seen: the RMS deviation of vertex normals, which changes smooth
// shading, and the KG error, which moves silhouettes. Chosen by pictures of ten animations
// (characters, animals, cloth and a robot of 290 to 46,434 vertices), shaded smoothly with
// highlights, beside the originals:
//   preview            dents are visible, the motion is right
//   good               close-ups show no ripples, as they do at 1.2 degrees; shading
//                      changes by 1.4 % of full brightness
//   fine               0.4 %, about one step of an 8-bit display
//   visually-lossless  0.14 %, less than half a step
// A KG error of 0.2 % is about a millimetre on a standing person, or a pixel of an image 1,800
// pixels tall.
struct NamedQuality {
  const char* word;
  double kg_error_percent;
  double max_normals;  // degrees

  // Low-delay mode does not bound normals: half the KG error, at which those of a cow, a dancer
  // and a flag keep about their bound.
  Target target(bool low_delay) const {
    return low_delay ? Target{Target::kKg, kg_error_percent / 2}
                     : Target{Target::kKg, kg_error_percent, max_normals};
  }
};
// fixed: From coarse to fine.
inline constexpr std::array<NamedQuality, 4> kQualities{{
    {"preview", 1.0, 4.0},
    {"good", 0.2, 0.8},
    {"fine", 0.06, 0.25},
    {"visually-lossless", 0.02, 0.08},
}};
inline constexpr NamedQuality kDefaultQuality = kQualities[1];  // fixed: for most purposes

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
