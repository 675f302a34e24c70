// 6.14.3: patches, the parts of a mesh that can each move by one affine motion in a frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::size_t kOffsetValues = 3;   // patch_residual: of the centre of the patch
inline constexpr std::size_t kMotionValues = 12;  // and the rows of a matrix

// patch_mode: how the vertices of a patch are predicted in a frame.
enum class PatchMode : std::uint8_t {
  kNeighbours,  // vertex type 3 of Ramanathan, Kassim and Tan (2008): from those around
  kMotion,      // type 2: by the motion of the patch
  kAlone,       // type 1: likewise, without residuals
};
inline constexpr int kPatchModes = 3;

struct PatchMotion {
  PatchMode mode = PatchMode::kNeighbours;
  // In steps: the difference from the last motion of the patch, of frames of the same depth.
  std::array<std::int32_t, kMotionValues> residual{};

  bool operator==(const PatchMotion&) const = default;
};

// The patch of each vertex; empty: there are none.
using PatchOfVertex = Vector<std::uint16_t>;

// The patches of a frame; none: all are predicted from neighbours.
using FramePatches = Vector<PatchMotion>;

inline PatchMode mode_of(const FramePatches& patches, const PatchOfVertex& patch_of_vertex,
                         std::uint32_t v) {
  return patches.empty() ? PatchMode::kNeighbours : patches[patch_of_vertex[v]].mode;
}

}  // namespace rlpc
