#include "encoder/codec/sequence/check_frames.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/codec/syntax/sequence_header.h"
#include "encoder/meshes/mesh_text.h"

namespace rlpc {

std::optional<InputError> check_format(const FrameFormat& format) {
  if (format.num_vertices == 0) return InputError{"a mesh has at least one vertex"};
  if (format.num_frames > kMaxFrames) {
    return InputError{"a sequence has 1 to " + std::to_string(kMaxFrames) + " frames, not " +
                      std::to_string(format.num_frames)};
  }
  if (format.frame_rate.numerator == 0 || format.frame_rate.denominator == 0) {
    return InputError{"the frame rate has a zero numerator or denominator"};
  }
  if (format.least_level < 1 || format.least_level > kMaxLevelIdc) {
    return InputError{"levels are 1 to " + std::to_string(kMaxLevelIdc) + ", not " +
                      std::to_string(format.least_level)};
  }
  for (std::size_t t = 0; t < format.triangles.size(); ++t) {
    for (const std::uint32_t v : format.triangles[t]) {
      if (v < format.num_vertices) continue;
      return InputError{"triangle " + std::to_string(t) + " (from 0) has vertex " +
                        std::to_string(v) + " of " + std::to_string(format.num_vertices)};
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    constexpr float kMax = 0x1p100F;  // fixed: largest coordinate
    const float low = format.box_min[c];
    const float high = format.box_max[c];
    if (low <= high && low >= -kMax && high <= kMax) continue;
    return InputError{std::string("the box has no extent in ") + "xyz"[c] +
                      " within 2^100: " + shortest_text(low) + " to " + shortest_text(high)};
  }
  return std::nullopt;
}

std::optional<InputError> check_frame(const FrameFormat& format, std::uint32_t num_added,
                                      std::span<const float> xyz,
                                      std::span<const double> exact) {
  const std::string frame = "frame " + std::to_string(num_added) + " (from 0)";
  if (format.num_frames > 0 && num_added == format.num_frames) {
    return InputError{frame + " is one more than the number of frames announced, " +
                      std::to_string(format.num_frames)};
  }
  if (num_added == kMaxFrames) {
    return InputError{frame + " is one more than a sequence can have; begin another stream"};
  }
  if (xyz.size() != 3 * std::size_t{format.num_vertices}) {
    return InputError{frame + " has " + std::to_string(xyz.size()) + " values; " +
                      std::to_string(format.num_vertices) + " vertices have " +
                      std::to_string(3 * std::size_t{format.num_vertices})};
  }
  if (!exact.empty() && exact.size() != xyz.size()) {
    return InputError{frame + " has " + std::to_string(exact.size()) + " exact values for " +
                      std::to_string(xyz.size()) + " floats"};
  }
  if (!std::all_of(exact.begin(), exact.end(), [](double x) { return std::isfinite(x); })) {
    return InputError{frame + " has an exact value that is not finite"};
  }
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const std::size_t c = i % 3;
    if (xyz[i] >= format.box_min[c] && xyz[i] <= format.box_max[c]) continue;
    return InputError{frame + ", vertex " + std::to_string(i / 3) + ": " + "xyz"[c] + " is " +
                      shortest_text(xyz[i]) + ", outside the box announced, " +
                      shortest_text(format.box_min[c]) + " to " +
                      shortest_text(format.box_max[c])};
  }
  return std::nullopt;
}

std::optional<InputError> check_count(const FrameFormat& format, std::uint32_t num_added) {
  if (num_added == 0) return InputError{"a sequence has at least one frame"};
  if (num_added >= format.num_frames) return std::nullopt;
  return InputError{"the stream ends after " + std::to_string(num_added) + " of " +
                    std::to_string(format.num_frames) + " frames announced"};
}

}  // namespace rlpc
