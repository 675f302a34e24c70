// 6.14.3: patches, parts of a mesh predicted by one affine motion per frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::size_t kOffsetValues = 3;   // patch_residual: offset of the centre
inline constexpr std::size_t kMotionValues = 12;  // patch_residual: offset and rows of a matrix

// patch_mode: prediction of the vertices of a patch in a frame.
enum class PatchMode : std::uint8_t {
  kNeighbours,  // vertex type 3 of Ramanathan, Kassim and Tan (2008): from neighbours
  kMotion,      // type 2: by the motion of the patch, with residuals
  kAlone,       // type 1: by the motion of the patch, without residuals
};
inline constexpr int kPatchModes = 3;

struct PatchMotion {
  PatchMode mode = PatchMode::kNeighbours;
  // Difference from the last motion of the patch in a frame of the same depth, in steps.
  std::array<std::int32_t, kMotionValues> residual{};

  bool operator==(const PatchMotion&) const = default;
};

// Patch of each vertex; empty: no patches.
using PatchOfVertex = Vector<std::uint16_t>;

// Patches of a frame; empty: all are predicted from neighbours.
using FramePatches = Vector<PatchMotion>;

inline PatchMode mode_of(const FramePatches& patches, const PatchOfVertex& patch_of_vertex,
                         std::uint32_t v) {
  return patches.empty() ? PatchMode::kNeighbours : patches[patch_of_vertex[v]].mode;
}

}  // namespace rlpc
