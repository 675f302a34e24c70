// Reconstructs several frames of a GOF together, on one or more threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/memory/owned.h"
#include "decoder/codec/recon/gof_recon.h"

namespace rlpc {

// Frames per thread and pass: factors are read from memory once for all of them.
inline constexpr std::uint32_t kBandFrames = 4;

// Direction of the next frame from the last one.
enum class Direction : std::uint8_t { kForward, kBack, kElsewhere };

// Reconstructs one band per thread during playback in either direction; after a jump, starts
// with a single frame and doubles.
class FrameBand {
 public:
  explicit FrameBand(std::uint32_t threads)
      : max_count_(kBandFrames * threads), next_count_(max_count_) {}

  // Drops the frames held: another GOF follows.
  void clear() { count_ = 0; }
  // Sets the direction of the next call of frame().
  void turn(Direction direction);
  // Returns frame f of the GOF in decoded order, frame_size values; valid until the next call.
  std::span<const std::int32_t> frame(const GofRecon& recon, std::uint32_t f,
                                      std::size_t frame_size);

 private:
  void fill(const GofRecon& recon, std::uint32_t f, std::size_t frame_size);

  std::uint32_t max_count_;
  std::uint32_t next_count_;
  bool is_back_ = false;
  std::uint32_t first_ = 0;
  std::uint32_t count_ = 0;
  Vector<std::int32_t> positions_;  // [count_][frame_size]
};

}  // namespace rlpc
