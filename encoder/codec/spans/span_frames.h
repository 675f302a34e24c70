// The frames of a span as the encoder analyses them: in grid units, unrounded.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/codec/bits/int_math.h"
#include "common/codec/mesh/mesh.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/spans/frame_range.h"
#include "encoder/codec/spans/rig.h"

namespace rlpc {

struct SpanFrames {
  std::uint32_t num_vertices = 0;
  std::uint32_t num_frames = 0;
  std::vector<double> xyz;        // [num_frames][num_vertices][3], decoded vertex order
  std::uint32_t first_frame = 0;  // number in the sequence
  std::uint32_t num_gofs = 1;     // GOFs that the span is divided into
  bool has_followers = false;     // later spans may use the shared rig of this one
  std::shared_ptr<const Rig> input_rig = {};  // the rig of the input; null: not known
  std::shared_ptr<const Rig> rigid_rig = {};  // the same without its stretches; null: has none

  // Returns the GOFs, with frames counted from the start of the span.
  std::vector<FrameRange> gofs() const { return equal_ranges(num_frames, num_gofs); }
  const double* at(std::uint32_t frame, std::uint32_t vertex) const {
    return &xyz[(std::size_t{frame} * num_vertices + vertex) * 3];
  }
};

// Returns the sum of squared distances between the frames and the decoded positions, or an
// estimate from `max` evenly spaced frames. decode(f, positions) writes the positions of frame
// f, [num_vertices][3]; any thread may call it.
template <typename Decode>
double squared_error(const SpanFrames& frames, const Decode& decode,
                     std::uint32_t max = 0xFFFFFFFF) {
  constexpr std::size_t kTogether = 8;  // fixed: frames of a pass
  const std::size_t values = std::size_t{frames.num_vertices} * 3;
  const std::uint32_t count = std::min(max, frames.num_frames);
  std::vector<double> sums(count);
  for_ranges(count, kTogether, [&](std::size_t first, std::size_t end) {
    std::vector<std::int32_t> positions(values);
    for (std::size_t i = first; i < end; ++i) {
      // The middles of equal parts.
      const auto frame = static_cast<std::uint32_t>(
          (2 * std::uint64_t{i} + 1) * frames.num_frames / (2 * std::uint64_t{count}));
      decode(frame, std::span<std::int32_t>(positions));
      const double* original = frames.at(frame, 0);
      double sum = 0.0;
      for (std::size_t k = 0; k < values; ++k) {
        const double d = positions[k] - original[k];
        sum += d * d;
      }
      sums[i] = sum;
    }
  });
  double sum = 0.0;
  for (const double frame_sum : sums) sum += frame_sum;
  return sum * frames.num_frames / count;
}

// Returns the grid position nearest to a vertex, clipped to position_bits.
inline Vec3i nearest_position(const double* xyz, int position_bits) {
  Vec3i p{};
  for (std::size_t c = 0; c < 3; ++c) {
    p[c] = clip_signed(position_bits,
                       static_cast<std::int64_t>(xyz[c] < 0 ? xyz[c] - 0.5 : xyz[c] + 0.5));
  }
  return p;
}

}  // namespace rlpc
