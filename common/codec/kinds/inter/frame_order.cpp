#include "common/codec/kinds/inter/frame_order.h"

#include <cstddef>

#include "common/memory/owned.h"

namespace rlpc {

std::uint32_t FramePattern::period() const {
  if (kind == kDyadic) return 1U << period_log2;
  return kind == kExplicit ? static_cast<std::uint32_t>(entries.size()) : 1;
}

std::uint32_t FramePattern::num_depths() const {
  if (kind == kDyadic) return static_cast<std::uint32_t>(period_log2) + 1;
  std::uint32_t depths = 1;
  if (kind == kExplicit) {
    for (const PatternEntry& entry : entries) depths = std::max(depths, entry.depth + 1);
  }
  return depths;
}

// 8.19.1 MakeFrameOrder( )
FrameOrder::FrameOrder(const FramePattern& pattern, std::uint32_t num_frames)
    : place_of_(num_frames), last_use_(num_frames) {
  places_.reserve(num_frames);
  add({});
  const std::uint32_t period = pattern.period();
  for (std::uint32_t first = 0; first + 1 < num_frames;) {
    const std::uint32_t length = std::min(period, num_frames - 1 - first);
    add_period(pattern, first, length);
    first += length;
  }
}

// 8.19.1 AddPeriod( first, length )
void FrameOrder::add_period(const FramePattern& pattern, std::uint32_t first,
                            std::uint32_t length) {
  if (pattern.kind == FramePattern::kDyadic) return add_dyadic(first, length);
  if (pattern.kind == FramePattern::kExplicit && length == pattern.entries.size()) {
    for (const PatternEntry& entry : pattern.entries) {
      add({first + entry.offset, first + entry.reference[0], first + entry.reference[1],
           entry.depth});
    }
    return;
  }
  for (std::uint32_t f = first; f < first + length; ++f) {
    const std::uint32_t reference = pattern.kind == FramePattern::kFirst ? 0 : f;
    add({f + 1, reference, reference, 0});
  }
}

// 8.19.1 AddDyadicPeriod( first, length )
void FrameOrder::add_dyadic(std::uint32_t first, std::uint32_t length) {
  struct Span {
    std::uint32_t a;
    std::uint32_t b;
    std::uint32_t depth;
  };
  add({first + length, first, first, 0});
  Vector<Span> spans{{first, first + length, 1}};
  while (!spans.empty()) {
    const Span span = spans.back();
    spans.pop_back();
    if (span.b - span.a < 2) continue;
    const std::uint32_t middle = (span.a + span.b) / 2;
    add({middle, span.a, span.b, span.depth});
    spans.push_back({middle, span.b, span.depth + 1});
    spans.push_back({span.a, middle, span.depth + 1});
  }
}

void FrameOrder::add(const FramePlace& place) {
  const auto number = static_cast<std::uint32_t>(places_.size());
  places_.push_back(place);
  place_of_[place.frame] = number;
  last_use_[place.frame] = number;
  last_use_[place.first] = number;
  last_use_[place.second] = number;
}

bool FrameOrder::begins_as(const FrameOrder& other, std::uint32_t num_places) const {
  return num_places <= std::min(num_frames(), other.num_frames()) &&
         std::equal(places_.begin(), places_.begin() + static_cast<std::ptrdiff_t>(num_places),
                    other.places_.begin());
}

}  // namespace rlpc
