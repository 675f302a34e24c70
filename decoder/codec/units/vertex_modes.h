// Counts the vertices of each frame that follow the motion of their patch (8.19.5).
#pragma once

#include <cstdint>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/memory/owned.h"

namespace rlpc {

// Of one frame. All are 0 if it repeats another.
struct VertexModes {
  std::uint32_t from_neighbours = 0;
  std::uint32_t with_residuals = 0;     // that follow the motion of their patch
  std::uint32_t without_residuals = 0;  // likewise: of a patch without residuals, or all are 0

  bool operator==(const VertexModes&) const = default;
};

// [num_frames]; empty if the GOF has no patches.
Vector<VertexModes> vertex_modes(const InterGof& gof);

}  // namespace rlpc
