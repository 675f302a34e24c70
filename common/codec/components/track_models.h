// Contexts of tracks and of component headers (clause 9.6), for all kinds of GOF. The parser
// and the writer drive them in the same way.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/bits/residual_models.h"
#include "common/codec/components/track_order.h"

namespace rlpc {

// 9.6.1: running magnitude of residuals: a fast and a slow mean, with 8 fractional bits.
struct RunningMagnitude {
  std::uint32_t fast = 0;
  std::uint32_t slow = 0;

  void reset(std::uint32_t mean) { fast = slow = mean; }
  void update(std::uint32_t magnitude) {
    fast = update_mean(fast, magnitude, 2);
    slow = update_mean(slow, magnitude, 4);
  }
};

// 9.6.3 and 9.8.2 expected magnitude, from the running magnitude of a track and the running
// mean of a frame.
constexpr std::uint32_t expected_in_track(const RunningMagnitude& running,
                                          std::uint32_t mean_of_frame) {
  return (running.fast + running.slow + 2 * mean_of_frame) >> 6;
}

// 9.6.1 ClippedMagnitude( residual ): scaled to 8 fractional bits, as running means are.
constexpr std::uint32_t clipped_magnitude(std::int32_t residual) {
  return std::min<std::uint32_t>(magnitude_of(residual), 0x100000) << 8;
}

// Fields of cluster and component headers that are coded as differences.
enum class HeaderField : std::uint8_t {
  kNumComponents,
  kScaleIdx,
  kSpatialBits,
  kTemporalBits
};

// 9.8.1: models of residuals of bones or trajectories: one for level 0, one for all others.
using TrackModels = std::array<ResidualModels, 2>;
// Returns the index of a level in TrackModels.
constexpr std::size_t models_of_level(int level) { return level == 0 ? 0 : 1; }

// Running magnitudes of a track, [level][coordinate].
using TrackMagnitudes = std::array<std::array<RunningMagnitude, 3>, kMaxTrackLevels + 1>;

// 9.6.3 and 9.8.2 Expected magnitude of a residual of a track (of a seed vertex, a bone or a
// trajectory).
class TrackContext {
 public:
  // frame_mean [num_gof_frames]: running mean over the previous tracks, per frame; updated.
  explicit TrackContext(std::span<std::uint32_t> frame_mean) : frame_mean_(frame_mean) {}
  std::uint32_t expected(const TrackPlace& at, std::size_t c) const {
    const RunningMagnitude& mean = mean_[static_cast<std::size_t>(at.level)][c];
    return expected_in_track(mean, frame_mean_[at.frame]);
  }
  void update(const TrackPlace& at, std::size_t c, std::int32_t residual) {
    const std::uint32_t magnitude = magnitude_of(residual);
    mean_[static_cast<std::size_t>(at.level)][c].update(magnitude);
    frame_mean_[at.frame] = update_mean(frame_mean_[at.frame], magnitude, 3);
  }

 private:
  std::span<std::uint32_t> frame_mean_;
  TrackMagnitudes mean_;
};

}  // namespace rlpc
