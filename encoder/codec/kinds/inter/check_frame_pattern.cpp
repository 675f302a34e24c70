#include "encoder/codec/kinds/inter/check_frame_pattern.h"

#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

using std::to_string;

// Checks entries in order. Depths of the frames of a period; kMaxPatternDepths: not yet known.
class ExplicitCheck {
 public:
  explicit ExplicitCheck(std::size_t period) : depth_(period + 1, kMaxPatternDepths) {
    depth_[0] = 0;
  }

  std::optional<std::string> entry(const PatternEntry& e) {
    const std::string frame = "frame " + to_string(e.offset) + " of the pattern";
    if (e.offset == 0 || e.offset >= depth_.size()) {
      return frame + " is not one of 1 to " + to_string(depth_.size() - 1) +
             ": a pattern has each frame of its period once";
    }
    if (depth_[e.offset] != kMaxPatternDepths) return frame + " comes twice";
    for (const std::uint32_t offset : e.reference) {
      if (offset >= depth_.size() || depth_[offset] == kMaxPatternDepths) {
        return frame + " is predicted from frame " + to_string(offset) +
               ", which does not come before it";
      }
      if (e.depth < depth_[offset]) {
        return frame + " is less deep than frame " + to_string(offset) +
               ", from which it is predicted";
      }
    }
    const auto [a, b] = e.reference;
    if (a != b && (a > e.offset || b < e.offset)) {
      return frame + " has two references, but not one on each side, the earlier one first";
    }
    if (e.depth >= kMaxPatternDepths) return frame + " is deeper than 7";
    depth_[e.offset] = e.depth;
    return std::nullopt;
  }
  std::optional<std::string> finish() const {
    if (depth_.back() == 0) return std::nullopt;
    return "the last frame of a period must have depth 0";
  }

 private:
  std::vector<std::uint32_t> depth_;
};

}  // namespace

std::optional<std::string> error_of_pattern(const FramePattern& pattern) {
  if (pattern.kind == FramePattern::kDyadic &&
      (pattern.period_log2 < 1 || pattern.period_log2 > kMaxPatternPeriodLog2)) {
    return "dyadic patterns have periods of 2, 4, 8, 16, 32 or 64 frames";
  }
  if (pattern.kind == FramePattern::kExplicit) {
    if (pattern.entries.empty() || pattern.entries.size() > kMaxExplicitPeriod) {
      return "a pattern has 1 to " + to_string(kMaxExplicitPeriod) + " frames";
    }
    ExplicitCheck check(pattern.entries.size());
    for (const PatternEntry& entry : pattern.entries) {
      if (auto error = check.entry(entry)) return error;
    }
    if (auto error = check.finish()) return error;
  }
  if (pattern.temporal_layers < 1 || pattern.temporal_layers > pattern.num_depths()) {
    return "this pattern has 1 to " + to_string(pattern.num_depths()) +
           " temporal layers ('temporal_layers'), as many as its frames have depths";
  }
  return std::nullopt;
}

}  // namespace rlpc
