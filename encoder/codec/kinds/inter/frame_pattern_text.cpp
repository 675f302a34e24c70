#include "encoder/codec/kinds/inter/frame_pattern_text.h"

#include <bit>
#include <charconv>
#include <cstdint>
#include <string_view>

namespace rlpc {
namespace {

// Takes words off the beginning of a text.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  bool is_empty() const { return text_.empty(); }
  bool take(std::string_view word) {
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }
  std::optional<std::uint32_t> number() {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc()) return std::nullopt;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return value;
  }

 private:
  std::string_view text_;
};

std::optional<PatternEntry> parse_entry(Words& words) {
  PatternEntry entry;
  const auto offset = words.number();
  if (!offset || !words.take("<")) return std::nullopt;
  entry.offset = *offset;
  const auto first = words.number();
  if (!first) return std::nullopt;
  entry.reference.fill(*first);
  if (words.take("+")) {
    const auto second = words.number();
    if (!second) return std::nullopt;
    entry.reference[1] = *second;
  }
  if (words.take("@")) {
    const auto depth = words.number();
    if (!depth) return std::nullopt;
    entry.depth = *depth;
  }
  return entry;
}

}  // namespace

std::optional<FramePattern> parse_frame_pattern_text(std::string_view text) {
  FramePattern pattern;
  if (text == "previous") return pattern;
  if (text == "first") {
    pattern.kind = FramePattern::kFirst;
    return pattern;
  }
  Words words(text);
  if (words.take("dyadic:")) {
    const auto period = words.number();
    if (!period || !words.is_empty() || !std::has_single_bit(*period)) return std::nullopt;
    pattern.kind = FramePattern::kDyadic;
    pattern.period_log2 = std::countr_zero(*period);
    return pattern;
  }
  pattern.kind = FramePattern::kExplicit;
  do {
    const auto entry = parse_entry(words);
    if (!entry) return std::nullopt;
    pattern.entries.push_back(*entry);
  } while (words.take(","));
  return words.is_empty() ? std::optional(pattern) : std::nullopt;
}

std::string frame_pattern_text(const FramePattern& pattern) {
  using std::to_string;
  if (pattern.kind == FramePattern::kPrevious) return "previous";
  if (pattern.kind == FramePattern::kFirst) return "first";
  if (pattern.kind == FramePattern::kDyadic) return "dyadic:" + to_string(pattern.period());
  std::string text;
  for (const PatternEntry& entry : pattern.entries) {
    const auto [a, b] = entry.reference;
    if (!text.empty()) text += ",";
    text += to_string(entry.offset) + "<" + to_string(a);
    if (a != b) text += "+" + to_string(b);
    if (entry.depth > 0) text += "@" + to_string(entry.depth);
  }
  return text;
}

}  // namespace rlpc
