#include "decoder/codec/gofs/frame_band.h"

#include <algorithm>

#include "common/parallel/for_each.h"

namespace rlpc {

std::span<const std::int32_t> FrameBand::frame(const GofRecon& recon, std::uint32_t f,
                                               std::size_t frame_size) {
  if (f < first_ || f >= first_ + count_) fill(recon, f, frame_size);
  return std::span<const std::int32_t>(positions_)
      .subspan((f - first_) * frame_size, frame_size);
}

void FrameBand::turn(Direction direction) {
  is_back_ = direction == Direction::kBack;
  if (direction == Direction::kElsewhere) next_count_ = 1;
}

void FrameBand::fill(const GofRecon& recon, std::uint32_t f, std::size_t frame_size) {
  const std::uint32_t there = is_back_ ? f + 1 : recon.num_frames() - f;
  count_ = recon.is_ordered() ? 1 : std::min(next_count_, there);
  const std::uint32_t first = is_back_ ? f + 1 - count_ : f;
  first_ = first;
  next_count_ = std::min(2 * next_count_, max_count_);
  positions_.resize(count_ * frame_size);
  // No loop on threads, which would allocate memory.
  if (count_ <= kBandFrames) return recon.frames(first, count_, positions_);
  for_ranges(count_, kBandFrames, [&](std::size_t begin, std::size_t end) {
    const std::size_t count = end - begin;
    recon.frames(first + static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(count),
                 std::span(positions_).subspan(begin * frame_size, count * frame_size));
  });
}

}  // namespace rlpc
