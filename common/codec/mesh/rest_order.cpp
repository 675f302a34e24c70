#include "common/codec/mesh/rest_order.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "common/codec/mesh/vertex_layers.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kNotPlaced = 0xFFFFFFFF;
constexpr std::size_t kMaxCounted =
    3;  // maximum number of hinges that raise the priority of a vertex

// Groups indices into lists, in the order of appending.
ListOfLists<std::uint32_t> group_indices(
    std::size_t num_lists, const Vector<std::array<std::uint32_t, 4>>& lists_of_index) {
  Vector<std::uint32_t> first(num_lists + 1, 0);
  for (const auto& lists : lists_of_index) {
    for (const std::uint32_t list : lists) ++first[list + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  Vector<std::uint32_t> next(first.begin(), first.end() - 1);
  Vector<std::uint32_t> items(first.back());
  for (std::uint32_t i = 0; i < lists_of_index.size(); ++i) {
    for (const std::uint32_t list : lists_of_index[i]) items[next[list]++] = i;
  }
  return {std::move(first), std::move(items)};
}

}  // namespace

RestOrder::RestOrder(const Topology& topology, std::span<const Triangle> triangles)
    : place_(topology.earlier_neighbours.size(), kNotPlaced) {
  find_edges(triangles);
  make_order();
  make_rings(topology);
}

// 8.18.1 Hinges: FindHinges( )
void RestOrder::find_edges(std::span<const Triangle> triangles) {
  struct Side {
    std::uint32_t high;
    std::uint32_t corner;
    bool backward;
  };
  const auto is_regular = [](const Triangle& t) {
    return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
  };
  Vector<std::uint32_t> first(place_.size() + 1, 0);
  for (const Triangle& t : triangles) {
    if (!is_regular(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) ++first[std::min(t[k], t[(k + 1) % 3]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  Vector<Side> sides(first.back());
  Vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (const Triangle& t : triangles) {
    if (!is_regular(t)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[(k + 1) % 3];
      const std::uint32_t b = t[(k + 2) % 3];
      sides[next[std::min(a, b)]++] = {std::max(a, b), t[k], b < a};
    }
  }
  // First two sides, and number of sides, from the current lower vertex to a higher one.
  struct Across {
    std::array<std::uint32_t, 2> sides{};
    std::uint32_t count = 0;
  };
  Vector<Across> across(place_.size());
  edges_.reserve(sides.size() / 2);  // exact for a closed surface
  first_edge_.assign(place_.size() + 1, 0);
  for (std::uint32_t low = 0; low < place_.size(); ++low) {
    for (std::uint32_t i = first[low]; i < first[low + 1]; ++i) {
      Across& x = across[sides[i].high];
      if (x.count < 2) x.sides[x.count] = i;
      ++x.count;
    }
    for (std::uint32_t i = first[low]; i < first[low + 1]; ++i) {
      Across& x = across[sides[i].high];
      if (x.count == 2) {
        const Side& p = sides[x.sides[0]];
        const Side& q = sides[x.sides[1]];
        if (p.corner != q.corner) {
          edges_.push_back({low, p.high, {p.corner, q.corner}, {p.backward, q.backward}});
        }
      }
      x.count = 0;
    }
    first_edge_[low + 1] = static_cast<std::uint32_t>(edges_.size());
  }
  by_ends_.resize(edges_.size());
  std::iota(by_ends_.begin(), by_ends_.end(), 0U);
  for (std::size_t low = 0; low < place_.size(); ++low) {
    const auto from_low =
        std::span(by_ends_).subspan(first_edge_[low], first_edge_[low + 1] - first_edge_[low]);
    std::sort(from_low.begin(), from_low.end(), [this](std::uint32_t i, std::uint32_t j) {
      return edges_[i].high < edges_[j].high;
    });
  }
}

// 8.18.2 Order: MakeRestOrder( )
void RestOrder::make_order() {
  Vector<std::array<std::uint32_t, 4>> vertices(edges_.size());
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    vertices[i] = {edges_[i].low, edges_[i].high, edges_[i].corners[0], edges_[i].corners[1]};
  }
  const ListOfLists<std::uint32_t> edges_of_vertex = group_indices(place_.size(), vertices);
  Vector<std::uint8_t> num_known(edges_.size(), 0);
  Vector<std::uint8_t> degree(place_.size(), 0);
  std::array<Vector<std::uint32_t>, kMaxCounted + 1> queues;
  std::array<std::size_t, kMaxCounted + 1> heads{};
  Vector<std::uint32_t> first_hinge{0};
  first_hinge.resize(place_.size() + 1);
  Vector<Hinge> hinges_in_order;
  Vector<std::uint32_t> begin_of(place_.size());
  Vector<std::uint8_t> count_of(place_.size(), 0);
  order_.reserve(place_.size());
  std::uint32_t lowest = 0;
  while (order_.size() < place_.size()) {
    std::uint32_t v = kNotPlaced;
    for (std::size_t d = kMaxCounted; d > 0 && v == kNotPlaced; --d) {
      while (v == kNotPlaced && heads[d] < queues[d].size()) {
        const std::uint32_t u = queues[d][heads[d]++];
        if (place_[u] == kNotPlaced) v = u;
      }
    }
    if (v == kNotPlaced) {
      while (place_[lowest] != kNotPlaced) ++lowest;
      v = lowest;
    }
    place_[v] = static_cast<std::uint32_t>(order_.size());
    order_.push_back(v);
    begin_of[v] = static_cast<std::uint32_t>(hinges_in_order.size());
    for (const std::uint32_t i : edges_of_vertex[v]) {
      const Edge& edge = edges_[i];
      ++num_known[i];
      for (std::size_t k = 0; k < 2; ++k) {
        const std::uint32_t corner = edge.corners[k];
        if (num_known[i] == 4 && corner == v && count_of[v] < kMaxRestHinges) {
          hinges_in_order.push_back(edge.seen_from(k));
          ++count_of[v];
        }
        if (num_known[i] == 3 && place_[corner] == kNotPlaced && degree[corner] < kMaxCounted) {
          queues[++degree[corner]].push_back(corner);
        }
      }
    }
  }
  Vector<Hinge> hinges;
  hinges.reserve(hinges_in_order.size());
  for (std::size_t v = 0; v < place_.size(); ++v) {
    const auto vertex_hinges = std::span(hinges_in_order).subspan(begin_of[v], count_of[v]);
    hinges.insert(hinges.end(), vertex_hinges.begin(), vertex_hinges.end());
    first_hinge[v + 1] = static_cast<std::uint32_t>(hinges.size());
  }
  hinges_of_vertex_ = {std::move(first_hinge), std::move(hinges)};
}

// 8.18.2 Order: FindRestRing( v ), for all vertices
void RestOrder::make_rings(const Topology& topology) {
  Vector<std::uint32_t> first{0};
  Vector<std::uint32_t> items;
  for (std::uint32_t v = 0; v < place_.size(); ++v) {
    const auto add_once = [&](std::uint32_t u) {
      const auto ring = std::span(items).subspan(first.back());
      if (std::find(ring.begin(), ring.end(), u) == ring.end()) items.push_back(u);
    };
    for (const Hinge& hinge : hinges(v)) {
      add_once(hinge.a);
      add_once(hinge.b);
    }
    if (hinges(v).empty()) {
      const auto neighbours = topology.earlier_neighbours[v];
      const auto last = neighbours.last(std::min(neighbours.size(), kMaxRing));
      items.insert(items.end(), last.begin(), last.end());
      if (last.empty() && v > 0) items.push_back(v - 1);
    }
    first.push_back(static_cast<std::uint32_t>(items.size()));
  }
  rings_ = {std::move(first), std::move(items)};
}

std::optional<VertexOfHinge> RestOrder::across(const Hinge& hinge) const {
  const auto [low, high] = std::minmax(hinge.a, hinge.b);
  const auto from_low =
      std::span(by_ends_).subspan(first_edge_[low], first_edge_[low + 1] - first_edge_[low]);
  const auto found =
      std::lower_bound(from_low.begin(), from_low.end(), high,
                       [this](std::uint32_t i, std::uint32_t h) { return edges_[i].high < h; });
  if (found == from_low.end() || edges_[*found].high != high) return std::nullopt;
  const Edge& edge = edges_[*found];
  for (std::size_t k = 0; k < 2; ++k) {
    if (edge.corners[1 - k] != hinge.c) continue;
    return VertexOfHinge{edge.corners[k], edge.seen_from(k).a != hinge.a};
  }
  return std::nullopt;
}

}  // namespace rlpc
