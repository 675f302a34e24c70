// Counts the vertices of each frame that follow the motion of their patch (8.19.5).
#pragma once

#include <cstdint>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/memory/owned.h"

namespace rlpc {

// Numbers of vertices of one frame. All are 0 if it repeats another.
struct VertexModes {
  std::uint32_t from_neighbours = 0;
  std::uint32_t with_residuals = 0;     // follow the motion of their patch, with residuals
  std::uint32_t without_residuals = 0;  // follow it in a patch without residuals, or all are 0

  bool operator==(const VertexModes&) const = default;
};

// Returns the modes [num_frames]; empty if the GOF has no patches.
Vector<VertexModes> vertex_modes(const InterGof& gof);

}  // namespace rlpc
