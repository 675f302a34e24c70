// The time of clips (7.3, 7.15): frame k of a clip is its pose k intervals after its start, an
// interval being the reciprocal of the frame rate. n frames take n - 1 intervals; where a clip
// repeats, its end is the start of the next turn.
#pragma once

#include <cstdint>

#include "common/mesh/mesh.h"

namespace rlpc {

// Seconds from the first to the last of so many frames, num_frames >= 1.
inline double clip_seconds(FrameRate frame_rate, std::uint32_t num_frames) {
  return static_cast<double>(num_frames - 1) * frame_rate.denominator / frame_rate.numerator;
}

// Where a clip of num_frames >= 1 frames is after so many seconds: from 0, its first frame, to
// num_frames - 1, its last; between frames, with a fraction. seconds: not a NaN; below 0 is 0.
inline double clip_place(FrameRate frame_rate, std::uint32_t num_frames, double seconds,
                         bool repeats) {
  constexpr double kMost = 0x1p53;  // where doubles have no fraction left
  const double last = static_cast<double>(num_frames) - 1.0;
  double place = seconds * frame_rate.numerator / frame_rate.denominator;
  if (!(place > 0.0) || last == 0.0) return 0.0;
  if (place > kMost) place = kMost;
  if (!repeats) return place < last ? place : last;
  // Not fmod: the decoder's library needs no mathematical functions.
  place -= last * static_cast<double>(static_cast<std::uint64_t>(place / last));
  return place < 0.0 || place >= last ? 0.0 : place;
}

}  // namespace rlpc
