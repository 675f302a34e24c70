#include "common/codec/components/track_order.h"

#include <algorithm>
#include <cassert>

#include "common/memory/owned.h"

namespace rlpc {

Vector<TrackPlace> track_order(std::uint32_t num_frames, int track_levels, int between) {
  assert(track_levels >= 0 && track_levels <= kMaxTrackLevels);
  const int levels = between > 0 ? track_levels : 0;
  Vector<TrackPlace> order;
  order.reserve(num_frames);
  for (int level = 0; level <= levels; ++level) {
    const std::uint32_t stride = std::uint32_t{1} << (levels - level);
    const std::uint32_t first = level == 0 ? 0 : stride;
    const std::uint32_t distance = level == 0 ? stride : 2 * stride;
    for (std::uint32_t f = first; f < num_frames; f += distance) {
      int neighbours = 0;
      if (level > 0 && f + stride < num_frames) {
        const bool four = between == 2 && f >= 3 * stride && f + 3 * stride < num_frames;
        neighbours = four ? 4 : 2;
      }
      order.push_back({f, stride, level, neighbours});
    }
  }
  return order;
}

Vector<TrackPlace> places_of_layer(const TrackFrames& frames, int between, int layer) {
  assert(frames.temporal_layers >= 1 && frames.temporal_layers <= frames.levels + 1);
  const int below = frames.levels - (frames.temporal_layers - 1);  // highest level of layer 0
  Vector<TrackPlace> places = track_order(frames.count, frames.levels, between);
  std::erase_if(places,
                [&](const TrackPlace& at) { return std::max(at.level - below, 0) != layer; });
  return places;
}

}  // namespace rlpc
