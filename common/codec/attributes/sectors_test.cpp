#include "common/codec/attributes/sectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/codec/mesh/corners.h"

namespace rlpc {
namespace {

using Indices = std::vector<std::uint32_t>;

Indices list(std::span<const std::uint32_t> items) { return {items.begin(), items.end()}; }

// Edge 0 to 1 is shared by the first two triangles; they are sides of a square.
TEST(EdgeMates, RunInOppositeDirections) {
  const std::vector<Triangle> square{{0, 1, 2}, {1, 0, 3}};
  const Indices mates = find_edge_mates(4, square);
  EXPECT_EQ(mates, (Indices{3, kNoCorner, kNoCorner, 0, kNoCorner, kNoCorner}));
  const std::vector<Triangle> turned{{0, 1, 2}, {0, 1, 3}};
  EXPECT_EQ(find_edge_mates(4, turned), Indices(6, kNoCorner));
}

TEST(EdgeMates, ThereIsNoneOfThreeTriangles) {
  const std::vector<Triangle> book{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  EXPECT_EQ(find_edge_mates(5, book), Indices(9, kNoCorner));
}

TEST(EdgeMates, TrianglesWithAVertexTwiceAreIgnored) {
  const std::vector<Triangle> mesh{{0, 1, 2}, {0, 0, 1}, {1, 0, 3}, {0, 1, 1}};
  const Indices mates = find_edge_mates(4, mesh);
  EXPECT_EQ(mates[0], 6U);
  EXPECT_EQ(mates[6], 0U);
  EXPECT_EQ(std::count(mates.begin(), mates.end(), kNoCorner), 10);
}

// Four triangles around vertex 0; the outer vertices are 1 to 4.
class Fan : public ::testing::Test {
 protected:
  const std::vector<Triangle> triangles_{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  const Indices mates_ = find_edge_mates(5, triangles_);
  std::vector<bool> seams_ = std::vector<bool>(12, false);

  void set_seam(std::uint32_t edge) {
    seams_[edge] = true;
    seams_[mates_[edge]] = true;
  }
};

TEST_F(Fan, CornersWithoutSeamAreOneSector) {
  const Sectors sectors = sectors_of_corners(mates_, seams_);
  EXPECT_EQ(sectors.count(), 5U);
  EXPECT_EQ(list(sectors.corners[0]), (Indices{0, 3, 6, 9}));
}

TEST_F(Fan, OneSeamAtAnInnerVertexSeparatesNothingThere) {
  set_seam(2);  // from vertex 2 to the centre
  const Sectors sectors = sectors_of_corners(mates_, seams_);
  EXPECT_EQ(list(sectors.corners[0]), (Indices{0, 3, 6, 9}));
  EXPECT_EQ(sectors.count(), 6U);  // two at vertex 2
}

TEST_F(Fan, TwoSeamsSeparateTwoSectors) {
  set_seam(2);
  set_seam(8);
  const Sectors sectors = sectors_of_corners(mates_, seams_);
  EXPECT_EQ(list(sectors.corners[sectors.sector_of_corner[0]]), (Indices{0, 9}));
  EXPECT_EQ(list(sectors.corners[sectors.sector_of_corner[3]]), (Indices{3, 6}));
  EXPECT_EQ(sectors.count(), 8U);
}

TEST_F(Fan, SectorsAreNumberedByTheirFirstCorners) {
  set_seam(2);
  set_seam(8);
  const Sectors sectors = sectors_of_corners(mates_, seams_);
  std::uint32_t next = 0;
  for (const std::uint32_t x : sectors.sector_of_corner) {
    ASSERT_LE(x, next);
    if (x == next) ++next;
  }
  EXPECT_EQ(next, sectors.count());
}

TEST_F(Fan, OrderFollowsCompleteTriangles) {
  const SectorOrder order(sectors_of_vertices(5, triangles_));
  EXPECT_EQ(order.order, (Indices{0, 1, 2, 4, 3}));
  EXPECT_EQ(order.class_of, (std::vector<std::uint8_t>{0, 1, 2, 3, 2}));
  EXPECT_EQ(list(order.triangles[3]), (Indices{5, 7}));
  EXPECT_EQ(order.neighbour, (Indices{kNoSector, 0, 0, 0, 0}));
}

TEST(SectorOrder, IsolatedVerticesFollowTheOneBefore) {
  const std::vector<Triangle> none;
  const SectorOrder order(sectors_of_vertices(3, none));
  EXPECT_EQ(order.order, (Indices{0, 1, 2}));
  EXPECT_EQ(order.neighbour, (Indices{kNoSector, 0, 1}));
  EXPECT_EQ(order.class_of, (std::vector<std::uint8_t>{0, 0, 0}));
}

TEST(SectorOrder, TrianglesAndNeighboursOfASectorAreLimited) {
  // All triangles of 12 vertices.
  std::vector<Triangle> all;
  for (std::uint32_t a = 0; a < 12; ++a) {
    for (std::uint32_t b = a + 1; b < 12; ++b) {
      for (std::uint32_t c = b + 1; c < 12; ++c) all.push_back({a, b, c});
    }
  }
  const SectorOrder order(sectors_of_vertices(12, all));
  std::size_t max_triangles = 0;
  std::size_t max_ring = 0;
  for (std::uint32_t x = 0; x < 12; ++x) {
    max_triangles = std::max(max_triangles, order.triangles[x].size());
    max_ring = std::max(max_ring, order.ring[x].size());
  }
  EXPECT_EQ(max_triangles, kMaxSectorTriangles);
  EXPECT_EQ(max_ring, kMaxSectorRing);
}

}  // namespace
}  // namespace rlpc
