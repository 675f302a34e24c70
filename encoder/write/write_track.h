// Writes the residuals of a track; the counterpart of decoder/parse/parse_track.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/components/track_models.h"
#include "common/mesh/mesh.h"
#include "encoder/write/write_residual.h"

namespace rlpc {

// frame_mean [num_gof_frames]: running means over the tracks, updated. Coder: as in
// write_residual().
template <class Coder>
void write_track(Coder& re, ResidualModels& models, std::span<std::uint32_t> frame_mean,
                 std::span<const Vec3i> residuals) {
  TrackContext context(frame_mean);
  for (std::uint32_t f = 0; f < residuals.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      write_residual(re, models, context.expected(f, c), residuals[f][c]);
      context.update(f, c, residuals[f][c]);
    }
  }
}

}  // namespace rlpc
