// 7.14.1 Frame pattern: the coding order of the frames of an inter GOF, and the references of
// each frame.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "common/memory/owned.h"

namespace rlpc {

inline constexpr int kMaxPatternPeriodLog2 = 6;          // R-FRM-05
inline constexpr std::uint32_t kMaxExplicitPeriod = 32;  // 6.14.1
inline constexpr std::uint32_t kMaxPatternDepths = 8;    // 6.14.1

// Entry of an explicit pattern. Offsets are frames of a period, from 1; 0: the last frame
// before it.
struct PatternEntry {
  std::uint32_t offset = 1;
  std::array<std::uint32_t, 2> reference{};  // equal: a single reference
  std::uint32_t depth = 0;

  bool operator==(const PatternEntry&) const = default;
};

struct FramePattern {
  // frame_pattern_idc
  enum Kind : std::uint8_t { kPrevious, kFirst, kDyadic, kExplicit };
  Kind kind = kPrevious;
  int period_log2 = 1;                // kDyadic
  Vector<PatternEntry> entries;       // kExplicit, in coding order: as many as the period
  std::uint32_t temporal_layers = 1;  // 1 to num_depths()

  std::uint32_t period() const;
  std::uint32_t num_depths() const;
  // 8.19.1 TemporalLayerOfFrame( f ), for frames of a depth.
  std::uint32_t temporal_layer(std::uint32_t depth) const {
    const std::uint32_t deeper = num_depths() - temporal_layers;
    return depth - std::min(depth, deeper);
  }
  bool operator==(const FramePattern&) const = default;
};

// Place of a frame in coding order.
struct FramePlace {
  std::uint32_t frame = 0;
  std::uint32_t first = 0;   // FirstReference
  std::uint32_t second = 0;  // SecondReference
  std::uint32_t depth = 0;

  // Returns the place with a single, different reference.
  FramePlace from(std::uint32_t reference) const {
    return {frame, reference, reference, depth};
  }
  bool operator==(const FramePlace&) const = default;
};

// Coding order of a GOF with at least 1 frame.
class FrameOrder {
 public:
  FrameOrder(const FramePattern& pattern, std::uint32_t num_frames);

  std::uint32_t num_frames() const { return static_cast<std::uint32_t>(places_.size()); }
  const FramePlace& operator[](std::uint32_t place) const { return places_[place]; }
  std::uint32_t place_of(std::uint32_t frame) const { return place_of_[frame]; }
  // Returns the last place whose frame is predicted from `frame`, or the place of `frame`
  // itself.
  std::uint32_t last_use(std::uint32_t frame) const { return last_use_[frame]; }
  // R-FRM-04: returns whether both orders have the same first places.
  bool begins_as(const FrameOrder& other, std::uint32_t num_places) const;

 private:
  void add_period(const FramePattern& pattern, std::uint32_t first, std::uint32_t length);
  void add_dyadic(std::uint32_t first, std::uint32_t length);
  void add(const FramePlace& place);

  Vector<FramePlace> places_;
  Vector<std::uint32_t> place_of_;  // [frame]
  Vector<std::uint32_t> last_use_;  // [frame]
};

}  // namespace rlpc
