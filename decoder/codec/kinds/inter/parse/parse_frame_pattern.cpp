#include "decoder/codec/kinds/inter/parse/parse_frame_pattern.h"

#include <array>
#include <cstdint>
#include <optional>

namespace rlpc {
namespace {

constexpr const char* kRule = "R-FRM-06";

// 6.14.1 explicit_pattern( )
class ExplicitPattern {
 public:
  ExplicitPattern(BitReader& r, std::uint32_t period) : r_(r), period_(period) {
    depth_at_[0] = 0;
  }

  // pattern_entry( )
  PatternEntry entry() {
    PatternEntry entry;
    std::uint64_t at = r_.bit_pos();
    entry.offset = r_.u(5, "pattern_offset_minus1") + 1;
    check(entry.offset <= period_ && !depth_at_[entry.offset],
          {"pattern_offset_minus1", std::int64_t{entry.offset} - 1, at});
    const bool has_two = r_.flag("two_references_flag");
    for (std::size_t i = 0; i < 2; ++i) {
      if (i == 1 && !has_two) {
        entry.reference[1] = entry.reference[0];
        continue;
      }
      at = r_.bit_pos();
      entry.reference[i] = r_.u(6, "pattern_reference");
      check(entry.reference[i] <= period_ && depth_at_[entry.reference[i]].has_value(),
            {"pattern_reference", entry.reference[i], at});
    }
    if (has_two && is_legal_) {
      check(entry.reference[0] < entry.offset && entry.reference[1] > entry.offset,
            {"pattern_reference", entry.reference[1], at});
    }
    at = r_.bit_pos();
    last_depth_ = {"pattern_depth", r_.u(3, "pattern_depth"), at};
    entry.depth = static_cast<std::uint32_t>(last_depth_.value);
    for (const std::uint32_t offset : entry.reference) {
      if (is_legal_) check(entry.depth >= depth_at_[offset].value_or(0), last_depth_);
    }
    stop_if_illegal();
    depth_at_[entry.offset] = entry.depth;
    return entry;
  }
  void finish() {
    check(depth_at_[period_] == 0U, last_depth_);
    stop_if_illegal();
  }

 private:
  void check(bool is_legal, const ReadElement& element) {
    is_legal_ &= r_.require(element, is_legal, kRule);
  }
  // Entries and temporal layers depend on the entries before them.
  void stop_if_illegal() {
    if (!is_legal_) r_.stop();
  }

  BitReader& r_;
  std::uint32_t period_;
  bool is_legal_ = true;
  ReadElement last_depth_;
  std::array<std::optional<std::uint32_t>, 1 << 6>
      depth_at_;  // DepthAtOffset; none: not set yet
};

}  // namespace

// 6.14.1 frame_pattern( )
FramePattern parse_frame_pattern(BitReader& r) {
  FramePattern pattern;
  pattern.kind = static_cast<FramePattern::Kind>(r.u(2, "frame_pattern_idc"));
  if (pattern.kind == FramePattern::kDyadic) {
    pattern.period_log2 = static_cast<int>(r.u(
        3, "pattern_period_log2", {1, kMaxPatternPeriodLog2}, "R-FRM-05", AfterBroken::kStop));
  } else if (pattern.kind == FramePattern::kExplicit) {
    const std::uint32_t period = r.u(5, "pattern_period_minus1") + 1;
    ExplicitPattern entries(r, period);
    for (std::uint32_t k = 0; k < period && !r.stopped(); ++k) {
      pattern.entries.push_back(entries.entry());
    }
    entries.finish();
  }
  if (r.stopped() || pattern.num_depths() == 1) return pattern;
  pattern.temporal_layers =
      r.u(3, "temporal_layers_minus1", {0, std::int64_t{pattern.num_depths()} - 1}, "R-FRM-07",
          AfterBroken::kStop) +
      1;
  return pattern;
}

}  // namespace rlpc
