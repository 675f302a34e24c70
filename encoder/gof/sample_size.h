// Sizes of the samples of a GOF that are analysed in place of all of it.
#pragma once

#include <cstdint>

namespace rlpc {

// tuned: Bones are fitted to a sample of at most this many frames. Fewer miss motion; more take
// time in proportion.
inline constexpr std::uint32_t kSampleFrames = 24;
// tuned: Bones are fitted to a sample of at most this many vertices. Fewer miss small parts of
// the mesh; more take time in proportion.
inline constexpr std::uint32_t kSampleVertices = 3000;
// tuned (off: 1): Of small meshes, the sample has up to this many times as many frames, ...
inline constexpr std::uint32_t kSmallMeshFrames = 3;
// tuned (off: 1): ... as long as it has at most this many positions.
inline constexpr std::uint32_t kSamplePositions = 48000;
// tuned (off: 1): The sample for expected costs has this fraction of the frames and of the
// vertices. It is analysed for every number of bones, so its size decides the time of the
// estimates.
inline constexpr std::uint32_t kQuickPart = 2;
// tuned: Vertices that stand for the whole mesh in estimates that are averages: costs of GOFs,
// smoothness of motion, predictability of trajectories. More vertices hardly change an average.
inline constexpr std::uint32_t kProbeVertices = 160;

}  // namespace rlpc
