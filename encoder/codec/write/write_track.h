// Writes the residuals of a track; the counterpart of decoder/codec/parse/parse_track.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/components/track_models.h"
#include "common/codec/mesh/mesh.h"
#include "encoder/codec/write/write_residual.h"

namespace rlpc {

// frame_mean: [num_gof_frames], running means over the tracks, updated. models: for level 0,
// and for other levels if `order` has any. Coder: as in write_residual().
template <class Coder>
void write_track(Coder& re, std::span<ResidualModels> models,
                 std::span<std::uint32_t> frame_mean, std::span<const TrackPlace> order,
                 std::span<const Vec3i> residuals) {
  TrackContext context(frame_mean);
  for (const TrackPlace& at : order) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t residual = residuals[at.frame][c];
      write_residual(re, models[models_of_level(at.level)], context.expected(at, c), residual);
      context.update(at, c, residual);
    }
  }
}

}  // namespace rlpc
