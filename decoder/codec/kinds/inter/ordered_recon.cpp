#include "decoder/codec/kinds/inter/ordered_recon.h"

#include <algorithm>
#include <cstddef>

#include "common/memory/owned.h"

namespace rlpc {

void OrderedRecon::frames(std::uint32_t first, std::uint32_t count,
                          std::span<std::int32_t> positions) const {
  const std::lock_guard lock(decoding_);
  const std::size_t values = 3 * std::size_t{mesh_.num_vertices()};
  for (std::uint32_t i = 0; i < count; ++i) {
    go_to(first + i);
    const Vector<std::int32_t>& decoded = decoded_.at(first + i);
    std::copy(decoded.begin(), decoded.end(),
              positions.begin() + static_cast<std::ptrdiff_t>(i * values));
  }
}

void OrderedRecon::make_ready(std::uint32_t f) const {
  const std::lock_guard lock(decoding_);
  go_to(f);
}

// The reconstruction keeps the first frame, from which independent frames are predicted, up to
// the last place.
bool OrderedRecon::can_go_back_to(std::uint32_t place) const {
  return place > 0 && recon_->has_independent_frames() && recon_->place() < num_frames();
}

// Decodes up to a frame, and drops frames long before it.
void OrderedRecon::go_to(std::uint32_t frame) const {
  const std::uint32_t first_kept = frame - std::min(frame, num_kept_);
  const std::uint32_t place = order_.place_of(frame);
  if (decoded_.contains(frame)) {
    decoded_.erase(decoded_.begin(), decoded_.lower_bound(first_kept));
    return;
  }
  if (!recon_ || (place < recon_->place() && !can_go_back_to(place))) {
    recon_.emplace(mesh_, gof_, position_bits_);
    decoded_.clear();
  } else if (place < recon_->place()) {
    recon_->skip_to(place);
  }
  while (recon_->place() <= place) {
    if (recon_->place() > 0 && recon_->has_independent_frames()) recon_->skip_to(place);
    const FramePlace& next = order_[recon_->place()];
    recon_->decode(next, order_.last_use(next.frame), (*gof_.frames)[next.frame]);
    if (next.frame < first_kept) continue;
    Vector<std::int32_t>& positions = decoded_[next.frame];
    positions.resize(3 * std::size_t{mesh_.num_vertices()});
    recon_->positions(positions);
  }
  decoded_.erase(decoded_.begin(), decoded_.lower_bound(first_kept));
}

}  // namespace rlpc
