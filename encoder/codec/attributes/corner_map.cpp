#include "encoder/codec/attributes/corner_map.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace rlpc {
namespace {

// A triangle turned to begin with its lowest corner: the turn, and its vertices.
struct Turned {
  std::uint32_t by = 0;
  Triangle triangle{};
};

Turned turned(const Triangle& t) {
  Turned best{0, t};
  for (std::uint32_t k = 1; k < 3; ++k) {
    const Triangle other{t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
    if (other < best.triangle) best = {k, other};
  }
  return best;
}

// Returns indices of triangles, sorted by their vertices, equal ones by index.
std::vector<std::uint32_t> sorted(const std::vector<Turned>& triangles) {
  std::vector<std::uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return triangles[a].triangle < triangles[b].triangle;
  });
  return order;
}

}  // namespace

std::vector<std::uint32_t> map_corners(const ConnectivityCode& connectivity,
                                       std::span<const Triangle> input) {
  assert(connectivity.triangles.size() == input.size());
  std::vector<Turned> theirs;
  theirs.reserve(input.size());
  for (const Triangle& t : input) theirs.push_back(turned(t));
  std::vector<Turned> ours;
  ours.reserve(input.size());
  for (Triangle t : connectivity.triangles) {
    for (std::uint32_t& v : t) v = connectivity.input_vertex[v];
    ours.push_back(turned(t));
  }
  const std::vector<std::uint32_t> their_order = sorted(theirs);
  const std::vector<std::uint32_t> our_order = sorted(ours);
  std::vector<std::uint32_t> map(3 * input.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    const std::uint32_t t = our_order[i];
    const std::uint32_t u = their_order[i];
    assert(ours[t].triangle == theirs[u].triangle);
    for (std::uint32_t k = 0; k < 3; ++k) {
      map[3 * t + (k + ours[t].by) % 3] = 3 * u + (k + theirs[u].by) % 3;
    }
  }
  return map;
}

}  // namespace rlpc
