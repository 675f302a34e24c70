#include "decoder/recon/ordered_recon.h"

#include <cstddef>

namespace rlpc {

void OrderedRecon::frames(std::uint32_t first, std::uint32_t count,
                          std::span<std::int32_t> positions) const {
  const std::lock_guard lock(decoding_);
  const std::size_t values = 3 * std::size_t{mesh_.num_vertices()};
  for (std::uint32_t i = 0; i < count; ++i) {
    go_to(first + i);
    recon_->positions(positions.subspan(i * values, values));
  }
}

// Makes a frame the last that was decoded.
void OrderedRecon::go_to(std::uint32_t frame) const {
  if (!recon_ || frame + 1 < recon_->frame()) {
    recon_.emplace(mesh_, gof_, position_bits_);
  }
  while (recon_->frame() <= frame) {
    if (recon_->frame() > 0 && recon_->has_independent_frames()) recon_->skip_to(frame);
    recon_->decode((*gof_.frames)[recon_->frame()]);
  }
}

}  // namespace rlpc
