// Contexts of tracks and of component headers (clause 9.6), for all kinds of GOF. The parser
// and the writer drive them in the same way.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/bitstream/residual_models.h"

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

// 9.6.3 and 9.8.2 Expected magnitude of a residual of a track (of a seed vertex, a bone or a
// trajectory).
class TrackContext {
 public:
  // frame_mean [num_gof_frames]: running mean over the previous tracks, per frame; updated.
  explicit TrackContext(std::span<std::uint32_t> frame_mean) : frame_mean_(frame_mean) {}
  std::uint32_t expected(std::uint32_t f, std::size_t c) const {
    return (mean_[c].fast + mean_[c].slow + 2 * frame_mean_[f]) >> 6;
  }
  void update(std::uint32_t f, std::size_t c, std::int32_t residual) {
    const std::uint32_t magnitude = magnitude_of(residual);
    mean_[c].update(magnitude);
    frame_mean_[f] = update_mean(frame_mean_[f], magnitude, 3);
  }

 private:
  std::span<std::uint32_t> frame_mean_;
  std::array<RunningMagnitude, 3> mean_;
};

}  // namespace rlpc
