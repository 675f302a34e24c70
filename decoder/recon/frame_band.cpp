#include "decoder/recon/frame_band.h"

#include <algorithm>
#include <future>

#include "decoder/recon/async.h"

namespace rlpc {

std::span<const std::int32_t> FrameBand::frame(const GofRecon& recon, std::uint32_t f,
                                               std::size_t frame_size) {
  if (f < first_ || f >= first_ + count_) fill(recon, f, frame_size);
  return std::span<const std::int32_t>(positions_)
      .subspan((f - first_) * frame_size, frame_size);
}

void FrameBand::fill(const GofRecon& recon, std::uint32_t first, std::size_t frame_size) {
  first_ = first;
  count_ = std::min(next_count_, recon.num_frames() - first);
  next_count_ = std::min(2 * next_count_, most_);
  positions_.resize(count_ * frame_size);
  const auto reconstruct = [&](std::uint32_t begin) {
    const std::uint32_t count = std::min(kBandFrames, count_ - begin);
    recon.frames(first + begin, count,
                 std::span(positions_).subspan(begin * frame_size, count * frame_size));
  };
  std::vector<std::future<bool>> others;
  for (std::uint32_t begin = kBandFrames; begin < count_; begin += kBandFrames) {
    others.push_back(run_async([&reconstruct, begin] { reconstruct(begin); }));
  }
  reconstruct(0);
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (!others[i].get()) reconstruct(static_cast<std::uint32_t>(i + 1) * kBandFrames);
  }
}

}  // namespace rlpc
