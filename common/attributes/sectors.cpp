#include "common/attributes/sectors.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "common/mesh/corners.h"
#include "common/owned.h"

namespace rlpc {
namespace {

ListOfLists<std::uint32_t> corners_of_sectors(std::uint32_t num_sectors,
                                              std::span<const std::uint32_t> of_corner) {
  Vector<std::uint32_t> first(num_sectors + std::size_t{1}, 0);
  for (const std::uint32_t x : of_corner) ++first[x + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  Vector<std::uint32_t> next(first.begin(), first.end() - 1);
  Vector<std::uint32_t> corners(of_corner.size());
  for (std::uint32_t c = 0; c < of_corner.size(); ++c) corners[next[of_corner[c]]++] = c;
  return {std::move(first), std::move(corners)};
}

}  // namespace

Sectors sectors_of_corners(std::span<const std::uint32_t> edge_mates,
                           const Vector<bool>& seams) {
  Sectors sectors;
  sectors.of_corner.assign(edge_mates.size(), kNoSector);
  std::uint32_t count = 0;
  Vector<std::uint32_t> pending;
  for (std::uint32_t c = 0; c < edge_mates.size(); ++c) {
    if (sectors.of_corner[c] != kNoSector) continue;
    const auto reach = [&](std::uint32_t corner) {
      if (sectors.of_corner[corner] != kNoSector) return;
      sectors.of_corner[corner] = count;
      pending.push_back(corner);
    };
    reach(c);
    while (!pending.empty()) {
      const std::uint32_t e = pending.back();
      pending.pop_back();
      if (edge_mates[e] != kNoCorner && !seams[e]) reach(next_corner(edge_mates[e]));
      const std::uint32_t before = previous_corner(e);
      if (edge_mates[before] != kNoCorner && !seams[before]) reach(edge_mates[before]);
    }
    ++count;
  }
  sectors.corners = corners_of_sectors(count, sectors.of_corner);
  return sectors;
}

Sectors sectors_of_vertices(std::uint32_t num_vertices, std::span<const Triangle> triangles) {
  Sectors sectors;
  sectors.of_corner.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    sectors.of_corner.insert(sectors.of_corner.end(), t.begin(), t.end());
  }
  sectors.corners = corners_of_sectors(num_vertices, sectors.of_corner);
  return sectors;
}

SectorOrder::SectorOrder(const Sectors& sectors) {
  constexpr std::size_t kMostCounted = 2;  // complete triangles that make a sector come earlier
  const std::uint32_t count = sectors.count();
  Vector<bool> is_placed(count, false);
  Vector<std::uint8_t> num_known(sectors.of_corner.size() / 3, 0);
  Vector<std::uint8_t> degree(count, 0);
  std::array<Vector<std::uint32_t>, kMostCounted> queues;
  std::array<std::size_t, kMostCounted> heads{};
  Vector<std::uint32_t> first_triangle(count);
  Vector<std::uint32_t> first_ring(count);
  Vector<std::uint8_t> num_triangles(count, 0);
  Vector<std::uint8_t> ring_size(count, 0);
  Vector<std::uint32_t> triangles_in_order;
  Vector<std::uint32_t> rings_in_order;
  order.reserve(count);
  neighbour.assign(count, kNoSector);
  class_of.assign(count, 0);

  const auto find_predictors = [&](std::uint32_t x) {
    first_triangle[x] = static_cast<std::uint32_t>(triangles_in_order.size());
    first_ring[x] = static_cast<std::uint32_t>(rings_in_order.size());
    const auto add_to_ring = [&](std::uint32_t y) {
      if (!is_placed[y] || ring_size[x] == kMaxSectorRing) return;
      const auto so_far = std::span(rings_in_order).subspan(first_ring[x]);
      if (std::find(so_far.begin(), so_far.end(), y) != so_far.end()) return;
      rings_in_order.push_back(y);
      ++ring_size[x];
    };
    for (const std::uint32_t c : sectors.corners[x]) {
      const std::uint32_t a = sectors.of_corner[next_corner(c)];
      const std::uint32_t b = sectors.of_corner[previous_corner(c)];
      if (is_placed[a] && is_placed[b] && num_triangles[x] < kMaxSectorTriangles) {
        triangles_in_order.push_back(c);
        ++num_triangles[x];
      }
      add_to_ring(a);
      add_to_ring(b);
    }
    if (ring_size[x] > 0) {
      class_of[x] = static_cast<std::uint8_t>(1 + std::min<int>(num_triangles[x], 2));
      neighbour[x] = rings_in_order[first_ring[x]];
    } else if (!order.empty()) {
      neighbour[x] = order.back();
    }
  };

  std::uint32_t lowest = 0;
  while (order.size() < count) {
    std::uint32_t x = kNoSector;
    for (std::size_t d = kMostCounted; d > 0 && x == kNoSector; --d) {
      std::size_t& head = heads[d - 1];
      while (x == kNoSector && head < queues[d - 1].size()) {
        const std::uint32_t y = queues[d - 1][head++];
        if (!is_placed[y]) x = y;
      }
    }
    if (x == kNoSector) {
      while (is_placed[lowest]) ++lowest;
      x = lowest;
    }
    find_predictors(x);
    is_placed[x] = true;
    order.push_back(x);
    for (const std::uint32_t c : sectors.corners[x]) {
      const std::uint32_t t = c / 3;
      if (++num_known[t] != 2) continue;
      for (std::uint32_t k = 3 * t; k < 3 * t + 3; ++k) {
        const std::uint32_t y = sectors.of_corner[k];
        if (!is_placed[y] && degree[y] < kMostCounted) queues[degree[y]++].push_back(y);
      }
    }
  }

  // From the order of coding to that of sectors.
  const auto regroup = [&](const Vector<std::uint32_t>& from, const Vector<std::uint8_t>& sizes,
                           const Vector<std::uint32_t>& items) {
    Vector<std::uint32_t> first{0};
    first.reserve(count + std::size_t{1});
    Vector<std::uint32_t> sorted;
    sorted.reserve(items.size());
    for (std::uint32_t x = 0; x < count; ++x) {
      const auto of_sector = std::span(items).subspan(from[x], sizes[x]);
      sorted.insert(sorted.end(), of_sector.begin(), of_sector.end());
      first.push_back(static_cast<std::uint32_t>(sorted.size()));
    }
    return ListOfLists<std::uint32_t>(std::move(first), std::move(sorted));
  };
  triangles = regroup(first_triangle, num_triangles, triangles_in_order);
  ring = regroup(first_ring, ring_size, rings_in_order);
}

}  // namespace rlpc
