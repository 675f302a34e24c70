// 8.17.1 Order of a track: the order in which the values of a track are coded. A sequential
// track goes from frame to frame. A hierarchical track has levels: level 0 is every
// 2^track_levels-th frame; each further level halves the distance.
// 8.17.3 Temporal layers: the highest levels can be sent separately.
#pragma once

#include <cstdint>

#include "common/memory/owned.h"

namespace rlpc {

inline constexpr int kMaxTrackLevels = 7;
// Largest value of rotation_between, origin_between and temporal_between. 0: sequential; 1:
// hierarchical, from two neighbours; 2: hierarchical, from four neighbours where they exist.
inline constexpr int kMaxBetween = 2;

// Place of a value in a track.
struct TrackPlace {
  std::uint32_t frame = 0;
  std::uint32_t stride = 1;  // earlier values at multiples of it are known
  int level = 0;
  int neighbours = 0;  // number that predict it from both sides: 0, 2 or 4
};

// 8.17.1 TrackOrder( between )
Vector<TrackPlace> track_order(std::uint32_t num_frames, int track_levels, int between);

// Frames and levels of all tracks of a GOF; a shared rig has none.
struct TrackFrames {
  std::uint32_t count = 0;  // num_gof_frames
  int levels = 0;           // track_levels
  int temporal_layers = 1;  // 1 to levels + 1
};

// 8.17.3 PlacesOfLayer( between, layer )
Vector<TrackPlace> places_of_layer(const TrackFrames& frames, int between, int layer);

// 8.17.2 Prediction at a place: a coordinate of the weighted sum of its neighbours.
// series(f) returns the value at frame f; |values| < 2^32.
template <class Series>
std::int64_t sum_of_neighbours(const Series& series, const TrackPlace& at) {
  const std::uint32_t f = at.frame;
  const std::uint32_t s = at.stride;
  const std::int64_t near = series(f - s) + series(f + s);
  if (at.neighbours == 2) return near;
  return 9 * near - series(f - 3 * s) - series(f + 3 * s);
}

}  // namespace rlpc
