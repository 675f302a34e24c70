#include "encoder/codec/kinds/skinned/tracks/residual_search.h"

namespace rlpc {

std::vector<TrackPlace> search_order(std::span<const TrackPlace> order) {
  // The frame that a place waits for, directly or through those that predict it.
  std::vector<std::uint32_t> awaited(order.size());
  for (const TrackPlace& at : order) {
    std::uint32_t& frame = awaited[at.frame];
    frame = at.frame;
    for (std::uint32_t k = 1; k <= 4 && k * at.stride <= at.frame; ++k) {
      if (at.neighbours > 0 && k % 2 == 0) continue;
      if (at.neighbours == 2 && k > 1) break;
      frame = std::max(frame, awaited[at.frame - k * at.stride]);
      if (at.neighbours > 0) frame = std::max(frame, awaited[at.frame + k * at.stride]);
    }
  }
  std::vector<TrackPlace> sorted(order.begin(), order.end());
  std::stable_sort(sorted.begin(), sorted.end(), [&](const TrackPlace& a, const TrackPlace& b) {
    return awaited[a.frame] < awaited[b.frame];
  });
  return sorted;
}

}  // namespace rlpc
