// Sizes of the samples of a GOF that are analysed instead of all of it.
#pragma once

#include <cstdint>

namespace rlpc {

// tuned: Bones are fitted to a sample of at most this many frames. Fewer miss motion; more take
// time in proportion.
inline constexpr std::uint32_t kSampleFrames = 24;
// tuned: Bones are fitted to a sample of at most this many vertices. Fewer miss small parts of
// the mesh; more take time in proportion.
inline constexpr std::uint32_t kSampleVertices = 3000;
// tuned: Vertices that stand for the whole mesh in estimates that are averages: costs of GOFs,
// smoothness of motion, predictability of trajectories. More vertices barely change an average.
inline constexpr std::uint32_t kProbeVertices = 160;

}  // namespace rlpc
