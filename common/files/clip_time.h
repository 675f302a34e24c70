// Clip time (7.3, 7.15): frame k of a clip is due k intervals after its start; an interval is
// the reciprocal of the frame rate. A clip of n frames lasts n - 1 intervals; when it repeats,
// its end is the start of the next pass. Times within a millionth of an interval of a frame, or
// of the middle between two frames, are rounded to it. The JavaScript package has the same
// rules (decoder/web/package/src/clip_time.js).
#pragma once

#include <cstdint>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Returns the seconds from the first frame to the last of num_frames >= 1 frames.
inline double clip_seconds(FrameRate frame_rate, std::uint32_t num_frames) {
  return static_cast<double>(num_frames - 1) * frame_rate.denominator / frame_rate.numerator;
}

inline constexpr double kExactPlace = 1e-6;  // intervals

// Returns the frame nearest to a place. 0 <= place < 2^32 - 1.
inline std::uint32_t nearest_frame(double place) {
  return static_cast<std::uint32_t>(place + (0.5 + kExactPlace));
}

// Returns the frame that a place equals up to rounding errors, otherwise the place.
inline double exact_place(double place) {
  const double frame = nearest_frame(place);
  const double off = place - frame;
  return off < kExactPlace && off > -kExactPlace ? frame : place;
}

// Returns the place in a clip of num_frames >= 1 frames at a time: from 0, its first frame, to
// num_frames - 1, its last; with a fraction between frames. seconds: not a NaN; negative: 0.
inline double clip_place(FrameRate frame_rate, std::uint32_t num_frames, double seconds,
                         bool repeats) {
  constexpr double kMax = 0x1p53;  // where doubles have no fraction left
  const double last = static_cast<double>(num_frames) - 1.0;
  double place = seconds * frame_rate.numerator / frame_rate.denominator;
  if (!(place > 0.0) || last == 0.0) return 0.0;
  if (place > kMax) place = kMax;
  if (!repeats) return place < last ? exact_place(place) : last;
  // Not fmod: the decoder's library needs no mathematical functions.
  place -= last * static_cast<double>(static_cast<std::uint64_t>(place / last));
  if (place < 0.0) return 0.0;
  place = exact_place(place);
  return place >= last ? 0.0 : place;
}

}  // namespace rlpc
