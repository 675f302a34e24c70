// Residuals of a track, parsing side: seed tracks (6.5.4), bones (6.11.2), trajectories
// (6.12.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/components/track_models.h"
#include "common/codec/mesh/mesh.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {

// Parses the residuals of a track. frame_mean [num_gof_frames]: running means, kept from track
// to track. models: of level 0, and of the other levels if `order` has any. residuals
// [num_gof_frames]: set at the places of `order`.
inline void parse_track(SectionReader& section, std::span<ResidualModels> models,
                        std::span<std::uint32_t> frame_mean, std::span<const TrackPlace> order,
                        std::span<Vec3i> residuals, const char* element) {
  if (section.failed()) return;
  TrackContext context(frame_mean);
  for (const TrackPlace& at : order) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::int32_t& residual = residuals[at.frame][c];
      residual =
          section.residual(models[models_of_level(at.level)], context.expected(at, c), element);
      context.update(at, c, residual);
    }
  }
}

}  // namespace rlpc
