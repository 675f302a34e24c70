#include "decoder/recon/ordered_recon.h"

#include <algorithm>
#include <cstddef>

namespace rlpc {

void OrderedRecon::frames(std::uint32_t first, std::uint32_t count,
                          std::span<std::int32_t> positions) const {
  const std::lock_guard lock(decoding_);
  const std::size_t values = 3 * std::size_t{mesh_.num_vertices()};
  for (std::uint32_t i = 0; i < count; ++i) {
    go_to(first + i);
    const std::vector<std::int32_t>& decoded = decoded_.at(first + i);
    std::copy(decoded.begin(), decoded.end(),
              positions.begin() + static_cast<std::ptrdiff_t>(i * values));
  }
}

// Decodes up to a frame, and drops those before it.
void OrderedRecon::go_to(std::uint32_t frame) const {
  const std::uint32_t place = order_.place_of(frame);
  if (!recon_ || (place < recon_->place() && !decoded_.contains(frame))) {
    recon_.emplace(mesh_, gof_, position_bits_);
    decoded_.clear();
  }
  while (recon_->place() <= place) {
    if (recon_->place() > 0 && recon_->has_independent_frames()) recon_->skip_to(place);
    const FramePlace& next = order_[recon_->place()];
    recon_->decode(next, order_.last_use(next.frame), (*gof_.frames)[next.frame]);
    if (next.frame < frame) continue;
    std::vector<std::int32_t>& positions = decoded_[next.frame];
    positions.resize(3 * std::size_t{mesh_.num_vertices()});
    recon_->positions(positions);
  }
  decoded_.erase(decoded_.begin(), decoded_.lower_bound(frame));
}

}  // namespace rlpc
