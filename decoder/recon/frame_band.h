// Frames of a GOF that were reconstructed together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "decoder/recon/gof_recon.h"

namespace rlpc {

// Frames that a thread reconstructs at a time: factors are read from memory once for them.
inline constexpr std::uint32_t kBandFrames = 4;

// A band for each thread; but a single frame after a seek, and then more and more.
class FrameBand {
 public:
  explicit FrameBand(std::uint32_t threads)
      : most_(kBandFrames * threads), next_count_(most_) {}

  // Another GOF: what is held is not of it.
  void clear() { count_ = 0; }
  // The next frame may be the only one that is wanted.
  void begin_small() { next_count_ = 1; }
  // Frame f of the GOF in decoded order, frame_size values; until the next call.
  std::span<const std::int32_t> frame(const GofRecon& recon, std::uint32_t f,
                                      std::size_t frame_size);

 private:
  void fill(const GofRecon& recon, std::uint32_t first, std::size_t frame_size);

  std::uint32_t most_;
  std::uint32_t next_count_;
  std::uint32_t first_ = 0;
  std::uint32_t count_ = 0;
  std::vector<std::int32_t> positions_;  // [count_][frame_size]
};

}  // namespace rlpc
