// When the frames of glTF clips are. Keys have times; frames are on a grid from time 0 on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/meshes/gltf/clip.h"

namespace rlpc {

// A grid of frames from time 0 on.
struct GltfFrameGrid {
  FrameRate rate;
  // Exporters may round times to milliseconds, which then stand for the nearest frames.
  bool has_milliseconds = false;
  std::string note{};  // for the user; empty: none

  // Whether a time is that of a frame, as far as its precision tells.
  bool holds(double seconds) const;
  // Number of frames of a clip, from time 0 to its end: that of the end itself, or the first
  // after it, is the last. At least 2 where the clip has any length.
  double num_frames(const GltfClip& clip) const;
  // The time to evaluate a frame of a clip at, for the last one not before the end of the clip.
  // Rounded like the times of keys, so that a frame at a key matches it exactly.
  double time_of(std::uint32_t frame, const GltfClip& clip) const;
};

// Chooses the grid of clips that follow one another in a sequence:
//   wanted  the rate that the user asks for, if any; it is taken
//   hint    the rate that the file states, if any; it is tried first
//
// Otherwise the rate at whose frames all keys of all clips are: 30 if it is one; or 24, 25, a
// rate of NTSC, the lowest whole number from 26 on; above 60, only if half of the frames are at
// keys. Where there is none, a note says what was chosen: one of these rates up to 60 at which
// all clips end with a frame (a single clip: 30, or one with half of its keys); otherwise for a
// single clip, the next rate from 30 on at which it does, and for several, the rate of most of
// them.
GltfFrameGrid choose_frame_grid(const std::vector<GltfClip>& clips,
                                const std::optional<FrameRate>& wanted,
                                const std::optional<FrameRate>& hint);

// Moves keys of steps to the frames that they are meant to be at, in clips whose keys are all
// on the grid: a step that rounding has put just after its frame would otherwise come one too
// late.
void align_steps(const GltfFrameGrid& grid, std::vector<GltfClip>& clips);

}  // namespace rlpc
