#include "common/codec/attributes/sectors.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "common/codec/mesh/corners.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

// Builds a list per sector, sector by sector in any order.
class ListsOfSectors {
 public:
  explicit ListsOfSectors(std::uint32_t num_sectors)
      : first_(num_sectors), size_(num_sectors) {}

  void begin(std::uint32_t x) { first_[x] = static_cast<std::uint32_t>(items_.size()); }
  void add(std::uint32_t x, std::uint32_t item) {
    items_.push_back(item);
    ++size_[x];
  }
  std::span<const std::uint32_t> of(std::uint32_t x) const {
    return std::span(items_).subspan(first_[x], size_[x]);
  }
  ListOfLists<std::uint32_t> in_order_of_sectors() const {
    Vector<std::uint32_t> first{0};
    first.reserve(first_.size() + 1);
    Vector<std::uint32_t> items;
    items.reserve(items_.size());
    for (std::uint32_t x = 0; x < first_.size(); ++x) {
      const auto sector_corners = of(x);
      items.insert(items.end(), sector_corners.begin(), sector_corners.end());
      first.push_back(static_cast<std::uint32_t>(items.size()));
    }
    return {std::move(first), std::move(items)};
  }

 private:
  Vector<std::uint32_t> first_;
  Vector<std::uint8_t> size_;
  Vector<std::uint32_t> items_;
};

// Queues of sectors that complete triangles, which come early; those of two or more come first.
class SectorQueues {
 public:
  explicit SectorQueues(const Sectors& sectors)
      : sectors_(sectors),
        is_placed_(sectors.count(), false),
        num_known_(sectors.sector_of_corner.size() / 3, 0),
        degree_(sectors.count(), 0) {}

  bool is_placed(std::uint32_t x) const { return is_placed_[x]; }
  // Returns a sector that has not been placed; one must exist.
  std::uint32_t next() {
    for (std::size_t d = kMaxCounted; d > 0; --d) {
      std::size_t& head = heads_[d - 1];
      while (head < queues_[d - 1].size()) {
        const std::uint32_t y = queues_[d - 1][head++];
        if (!is_placed_[y]) return y;
      }
    }
    while (is_placed_[lowest_]) ++lowest_;
    return lowest_;
  }
  void place(std::uint32_t x) {
    is_placed_[x] = true;
    for (const std::uint32_t c : sectors_.corners[x]) {
      const std::uint32_t t = c / 3;
      if (++num_known_[t] != 2) continue;
      for (std::uint32_t k = 3 * t; k < 3 * t + 3; ++k) {
        const std::uint32_t y = sectors_.sector_of_corner[k];
        if (!is_placed_[y] && degree_[y] < kMaxCounted) queues_[degree_[y]++].push_back(y);
      }
    }
  }

 private:
  static constexpr std::size_t kMaxCounted = 2;

  const Sectors& sectors_;
  Vector<bool> is_placed_;
  Vector<std::uint8_t> num_known_;  // [triangle] known corners
  Vector<std::uint8_t>
      degree_;  // [sector] triangles with two known corners, at most kMaxCounted
  std::array<Vector<std::uint32_t>, kMaxCounted> queues_;
  std::array<std::size_t, kMaxCounted> heads_{};
  std::uint32_t lowest_ = 0;
};

}  // namespace

ListOfLists<std::uint32_t> corners_of_sectors(std::uint32_t num_sectors,
                                              std::span<const std::uint32_t> sector_of_corner) {
  Vector<std::uint32_t> first(num_sectors + std::size_t{1}, 0);
  for (const std::uint32_t x : sector_of_corner) ++first[x + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  Vector<std::uint32_t> next(first.begin(), first.end() - 1);
  Vector<std::uint32_t> corners(sector_of_corner.size());
  for (std::uint32_t c = 0; c < sector_of_corner.size(); ++c)
    corners[next[sector_of_corner[c]]++] = c;
  return {std::move(first), std::move(corners)};
}

Sectors sectors_of_corners(std::span<const std::uint32_t> edge_mates,
                           const Vector<bool>& seams) {
  Sectors sectors;
  sectors.sector_of_corner.assign(edge_mates.size(), kNoSector);
  std::uint32_t count = 0;
  Vector<std::uint32_t> pending;
  for (std::uint32_t c = 0; c < edge_mates.size(); ++c) {
    if (sectors.sector_of_corner[c] != kNoSector) continue;
    const auto reach = [&](std::uint32_t corner) {
      if (sectors.sector_of_corner[corner] != kNoSector) return;
      sectors.sector_of_corner[corner] = count;
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
  sectors.corners = corners_of_sectors(count, sectors.sector_of_corner);
  return sectors;
}

Sectors sectors_of_vertices(std::uint32_t num_vertices, std::span<const Triangle> triangles) {
  Sectors sectors;
  sectors.sector_of_corner.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    sectors.sector_of_corner.insert(sectors.sector_of_corner.end(), t.begin(), t.end());
  }
  sectors.corners = corners_of_sectors(num_vertices, sectors.sector_of_corner);
  return sectors;
}

SectorOrder::SectorOrder(const Sectors& sectors) {
  const std::uint32_t count = sectors.count();
  SectorQueues queues(sectors);
  ListsOfSectors triangle_lists(count);
  ListsOfSectors rings(count);
  order.reserve(count);
  neighbour.assign(count, kNoSector);
  class_of.assign(count, 0);
  while (order.size() < count) {
    const std::uint32_t x = queues.next();
    triangle_lists.begin(x);
    rings.begin(x);
    const auto add_to_ring = [&](std::uint32_t y) {
      const auto so_far = rings.of(x);
      if (!queues.is_placed(y) || so_far.size() == kMaxSectorRing) return;
      if (std::find(so_far.begin(), so_far.end(), y) == so_far.end()) rings.add(x, y);
    };
    for (const std::uint32_t c : sectors.corners[x]) {
      const std::uint32_t a = sectors.sector_of_corner[next_corner(c)];
      const std::uint32_t b = sectors.sector_of_corner[previous_corner(c)];
      if (queues.is_placed(a) && queues.is_placed(b) &&
          triangle_lists.of(x).size() < kMaxSectorTriangles) {
        triangle_lists.add(x, c);
      }
      add_to_ring(a);
      add_to_ring(b);
    }
    if (!rings.of(x).empty()) {
      class_of[x] =
          static_cast<std::uint8_t>(1 + std::min<std::size_t>(triangle_lists.of(x).size(), 2));
      neighbour[x] = rings.of(x).front();
    } else if (!order.empty()) {
      neighbour[x] = order.back();
    }
    queues.place(x);
    order.push_back(x);
  }
  triangles = triangle_lists.in_order_of_sectors();
  ring = rings.in_order_of_sectors();
}

}  // namespace rlpc
