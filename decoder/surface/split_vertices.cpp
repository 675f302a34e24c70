#include "decoder/surface/split_vertices.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "common/codec/attributes/sectors.h"

namespace rlpc {
namespace {

using Indices = Vector<std::uint32_t>;

// Returns, for each value, the index of the first equal value.
Indices first_equals(const AttributeSet& set) {
  Indices first(set.num_values());
  std::iota(first.begin(), first.end(), 0U);
  if (set.header.has_faces()) return first;
  const std::size_t n = set.header.num_components;
  const auto compare = [&](std::uint32_t a, std::uint32_t b) {
    const auto* const end = set.values.data() + (a + 1) * n;
    const auto [x, y] = std::mismatch(end - n, end, set.values.data() + b * n);
    return x == end ? 0 : (*x < *y ? -1 : 1);
  };
  Indices sorted = first;
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
    const int order = compare(a, b);
    return order == 0 ? a < b : order < 0;
  });
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (compare(sorted[i - 1], sorted[i]) == 0) first[sorted[i]] = first[sorted[i - 1]];
  }
  return first;
}

// Returns the index of the value of each corner.
Indices values_of_corners(const AttributeSet& set, std::span<const Triangle> triangles) {
  assert(set.header.domain != AttributeDomain::kTriangle);
  const Indices first = first_equals(set);
  Indices values(3 * triangles.size());
  for (std::size_t c = 0; c < values.size(); ++c) {
    values[c] = set.value_of_corner.empty() ? triangles[c / 3][c % 3] : set.value_of_corner[c];
    if (values[c] < first.size()) values[c] = first[values[c]];  // smoothing has no values
  }
  return values;
}

}  // namespace

SplitVertices split_vertices(std::span<const Triangle> triangles, std::uint32_t num_vertices,
                             std::span<const AttributeSet* const> sets) {
  Vector<Indices> values;
  for (const AttributeSet* const set : sets) {
    values.push_back(values_of_corners(*set, triangles));
  }
  const auto compare = [&](std::uint32_t c, std::uint32_t d) {
    for (const Indices& set_values : values) {
      if (set_values[c] != set_values[d]) return set_values[c] < set_values[d] ? -1 : 1;
    }
    return 0;
  };
  const ListOfLists<std::uint32_t> all = sectors_of_vertices(num_vertices, triangles).corners;
  Indices corners;
  SplitVertices split;
  split.value_of_vertex.resize(sets.size());
  split.triangles.assign(triangles.begin(), triangles.end());
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    corners.assign(all[v].begin(), all[v].end());
    std::sort(corners.begin(), corners.end(), [&](std::uint32_t c, std::uint32_t d) {
      const int order = compare(c, d);
      return order == 0 ? c < d : order < 0;
    });
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t c = corners[i];
      if (i == 0 || compare(corners[i - 1], c) != 0) {
        split.stream_vertex.push_back(v);
        for (std::size_t s = 0; s < sets.size(); ++s) {
          split.value_of_vertex[s].push_back(values[s][c]);
        }
      }
      split.triangles[c / 3][c % 3] = split.num_vertices() - 1;
    }
    if (!corners.empty()) continue;
    split.stream_vertex.push_back(v);
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const bool has_own = sets[s]->header.domain == AttributeDomain::kVertex;
      split.value_of_vertex[s].push_back(has_own ? v : 0);
    }
  }
  return split;
}

}  // namespace rlpc
