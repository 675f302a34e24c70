// Residuals of a track, parsing side: seed tracks (6.5.4), bones (6.11.2), trajectories
// (6.12.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/components/track_models.h"
#include "common/mesh/mesh.h"
#include "decoder/parse/section_reader.h"

namespace rlpc {

// frame_mean [num_gof_frames]: running means, kept from track to track. One residual of three
// coordinates per frame.
inline std::vector<Vec3i> parse_track(SectionReader& section, ResidualModels& models,
                                      std::span<std::uint32_t> frame_mean,
                                      const char* element) {
  std::vector<Vec3i> residuals(frame_mean.size());
  if (section.failed()) return residuals;
  TrackContext context(frame_mean);
  for (std::uint32_t f = 0; f < residuals.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      residuals[f][c] = section.residual(models, context.expected(f, c), element);
      context.update(f, c, residuals[f][c]);
    }
  }
  return residuals;
}

}  // namespace rlpc
