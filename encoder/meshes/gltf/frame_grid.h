// Times of the frames of glTF clips. Keys have times; frames are on a grid from time 0 on.
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
  // Whether times are rounded to milliseconds, as by some exporters, and mean the nearest
  // frames.
  bool has_milliseconds = false;
  std::string note{};  // note for the user; empty: none

  // Whether a time is that of a frame, within its precision.
  bool holds(double seconds) const;
  // Returns the number of frames of a clip, from time 0 to its end: the last is the frame at
  // the end, or the first after it. At least 2 if the clip has any length.
  double num_frames(const GltfClip& clip) const;
  // Returns the time to evaluate a frame of a clip at; for the last one, not before the end of
  // the clip. Rounded like the times of keys, so that a frame at a key matches it exactly.
  double time_of(std::uint32_t frame, const GltfClip& clip) const;
};

// Chooses the grid of clips that follow one another in a sequence:
//   wanted  the rate that the user asks for, if any; it is used
//   hint    the rate that the file states, if any; it is tried first
//
// Otherwise, a rate at which all keys of all clips are at frames: 30 if possible; or 24, 25, a
// rate of NTSC, the lowest whole number from 26 on; above 60, only if half of the frames are at
// keys. If there is none, a note states the choice: one of these rates up to 60 at which all
// clips end with a frame (a single clip: 30, or one with half of its keys); otherwise, for a
// single clip, the next rate from 30 on at which it does, and for several, the rate of most of
// them.
GltfFrameGrid choose_frame_grid(const std::vector<GltfClip>& clips,
                                const std::optional<FrameRate>& wanted,
                                const std::optional<FrameRate>& hint);

// Moves keys of steps to the frames that they are meant for, in clips whose keys are all on the
// grid: a step that rounding has put just after its frame would otherwise come one frame late.
void align_steps(const GltfFrameGrid& grid, std::vector<GltfClip>& clips);

}  // namespace rlpc
