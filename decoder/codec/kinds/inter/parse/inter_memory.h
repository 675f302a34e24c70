// Estimates the memory of inter GOFs. Bounds as in memory_estimate.h.
#pragma once

#include <algorithm>
#include <cstdint>

#include "common/codec/kinds/inter/inter_gof.h"

namespace rlpc {

// Memory of an inter GOF: frames without their residuals, and their order; per vertex the
// position in several frames, neighbours and weights; with learned weights, errors and a filter
// per temporal layer; models of layer groups per depth; magnitudes of residuals, with several
// layer groups those of all frames.
inline std::uint64_t memory_of_frames(std::uint64_t num_vertices, std::uint64_t num_frames,
                                      const InterSettings& settings) {
  constexpr std::uint64_t kBytesPerFrame = 160;
  constexpr std::uint64_t kBytesPerVertex = 400;
  constexpr std::uint64_t kBytesOfOrder = 100;  // first frame: residuals, counterparts
  constexpr std::uint64_t kBytesOfFilter = 2600;
  constexpr std::uint64_t kBytesPerGroup = 6000;
  constexpr std::uint64_t kBytesOfMagnitude = 2;
  constexpr std::uint64_t kBytesOfKept = 24;  // a position in decoded and in output order
  const FramePattern& pattern = settings.pattern;
  const std::uint64_t depths = pattern.num_depths();
  const std::uint64_t kept =
      (pattern.kind == FramePattern::kExplicit ? pattern.period() : depths) +
      std::min<std::uint64_t>(settings.max_earlier_distance, num_frames);
  const std::uint64_t states = depths + 1;  // number of context states
  const std::uint64_t magnitudes =
      settings.layer_group_size.size() == 1 ? states + 1 : num_frames;
  constexpr std::uint64_t kBytesOfPatch = 160;  // its contexts, and its last motion
  const std::uint64_t filters = settings.learning_flag ? pattern.temporal_layers : 0;
  return num_frames * kBytesPerFrame +
         states * settings.layer_group_size.size() * kBytesPerGroup +
         states * settings.num_patches * kBytesOfPatch +
         num_vertices *
             (kBytesPerVertex + (settings.rest.order_flag ? kBytesOfOrder : 0) +
              filters * kBytesOfFilter + magnitudes * kBytesOfMagnitude + kept * kBytesOfKept);
}
// Memory of the residuals of a frame, of which some are large, and the motion of its patches.
constexpr std::uint64_t memory_of_frame(std::uint64_t num_vertices, std::uint64_t num_large,
                                        std::uint64_t num_patches) {
  return 5 * num_vertices + 32 * num_large + sizeof(PatchMotion) * num_patches;
}

}  // namespace rlpc
