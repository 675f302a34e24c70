#include "decoder/codec/kinds/inter/vertex_modes.h"

#include <cstddef>

#include "common/memory/owned.h"

namespace rlpc {
namespace {

bool has_residuals(const InterFrame& frame, std::size_t v) {
  if (frame.residual.size() == 0) return false;
  return frame.residual[3 * v] != 0 || frame.residual[3 * v + 1] != 0 ||
         frame.residual[3 * v + 2] != 0;
}

VertexModes modes_of(const InterFrame& frame, const PatchOfVertex& patch_of_vertex) {
  VertexModes modes;
  if (frame.repeated) return modes;
  for (std::uint32_t v = 0; v < patch_of_vertex.size(); ++v) {
    if (mode_of(frame.patches, patch_of_vertex, v) == PatchMode::kNeighbours) {
      ++modes.from_neighbours;
    } else {
      ++(has_residuals(frame, v) ? modes.with_residuals : modes.without_residuals);
    }
  }
  return modes;
}

}  // namespace

Vector<VertexModes> vertex_modes(const InterGof& gof) {
  Vector<VertexModes> modes;
  if (gof.num_patches == 0) return modes;
  for (const InterFrame& frame : *gof.frames) {
    modes.push_back(modes_of(frame, gof.patch_of_vertex));
  }
  return modes;
}

}  // namespace rlpc
