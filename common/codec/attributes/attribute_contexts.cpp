#include "common/codec/attributes/attribute_contexts.h"

namespace rlpc {
namespace {

bool are_equal(std::span<const std::uint32_t> values, std::uint32_t components, std::size_t a,
               std::size_t b) {
  const auto first = values.subspan(a * components, components);
  const auto second = values.subspan(b * components, components);
  return std::equal(first.begin(), first.end(), second.begin());
}

}  // namespace

void EarlierSets::add_triangle_values(std::span<const std::uint32_t> edge_mates,
                                      std::span<const std::uint32_t> values,
                                      std::uint32_t components) {
  for (std::uint32_t c = 0; c < edge_mates.size(); ++c) {
    if (edge_mates[c] == kNoCorner) continue;
    if (!are_equal(values, components, c / 3, edge_mates[c] / 3)) changes[c] = true;
  }
}

std::span<const std::uint32_t> TriangleContexts::find_candidates(
    std::uint32_t t, std::span<const std::uint32_t> values) {
  num_candidates_ = 0;
  for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c) {
    if (edge_mates_[c] == kNoCorner || edge_mates_[c] / 3 >= t) continue;
    const std::uint32_t u = edge_mates_[c] / 3;
    const auto known = std::span(candidates_).first(num_candidates_);
    const bool is_new = std::none_of(known.begin(), known.end(), [&](std::uint32_t w) {
      return are_equal(values, components_, w, u);
    });
    if (is_new) candidates_[num_candidates_++] = u;
  }
  if (num_candidates_ == 0 && t > 0) candidates_[num_candidates_++] = t - 1;
  return std::span(candidates_).first(num_candidates_);
}

}  // namespace rlpc
