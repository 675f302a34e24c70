#include "common/codec/mesh/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

using Indices = std::vector<std::uint32_t>;
using Triangles = std::vector<Triangle>;
using Corners = std::array<std::uint32_t, 3>;

Indices neighbours(const Topology& topology, std::size_t v) {
  const auto list = topology.earlier_neighbours[v];
  return {list.begin(), list.end()};
}

std::set<Corners> parallelograms(const Topology& topology, std::size_t v) {
  std::set<Corners> set;
  for (const Parallelogram& p : topology.parallelograms[v]) set.insert({p.a, p.b, p.c});
  EXPECT_EQ(set.size(), topology.parallelograms[v].size());
  return set;
}

TEST(Topology, IsEmptyForAPointCloud) {
  const Topology topology = make_topology(3, {});
  ASSERT_EQ(topology.earlier_neighbours.size(), 3U);
  ASSERT_EQ(topology.parallelograms.size(), 3U);
  for (std::size_t v = 0; v < 3; ++v) {
    EXPECT_TRUE(neighbours(topology, v).empty());
    EXPECT_TRUE(topology.parallelograms[v].empty());
  }
}

TEST(Topology, NeighboursAreEarlierAscendingAndUnique) {
  const Topology topology =
      make_topology(6, Triangles{{5, 3, 1}, {1, 3, 5}, {5, 4, 3}, {0, 5, 1}});
  EXPECT_EQ(neighbours(topology, 0), Indices{});
  EXPECT_EQ(neighbours(topology, 1), Indices{0});
  EXPECT_EQ(neighbours(topology, 2), Indices{});
  EXPECT_EQ(neighbours(topology, 3), Indices{1});
  EXPECT_EQ(neighbours(topology, 4), Indices{3});
  EXPECT_EQ(neighbours(topology, 5), (Indices{0, 1, 3, 4}));
}

TEST(Topology, DegenerateTrianglesMakeNeighboursButNoParallelograms) {
  const Topology topology =
      make_topology(4, Triangles{{1, 2, 1}, {0, 1, 2}, {3, 3, 3}, {2, 1, 3}});
  EXPECT_EQ(neighbours(topology, 2), (Indices{0, 1}));
  EXPECT_EQ(neighbours(topology, 3), (Indices{1, 2}));
  EXPECT_EQ(parallelograms(topology, 3), (std::set<Corners>{{1, 2, 0}}));
}

TEST(Topology, AParallelogramPredictsTheLaterCornerFromTheSharedEdge) {
  const Topology topology = make_topology(4, Triangles{{0, 1, 2}, {2, 1, 3}});
  for (std::size_t v = 0; v < 3; ++v) EXPECT_TRUE(topology.parallelograms[v].empty());
  ASSERT_EQ(topology.parallelograms[3].size(), 1U);
  const Parallelogram p = topology.parallelograms[3][0];
  EXPECT_EQ((std::set<std::uint32_t>{p.a, p.b}), (std::set<std::uint32_t>{1, 2}));
  EXPECT_EQ(p.c, 0U);
}

TEST(Topology, OrientationDoesNotMatter) {
  const Topology topology = make_topology(4, Triangles{{0, 1, 2}, {1, 2, 3}});
  EXPECT_EQ(parallelograms(topology, 3), (std::set<Corners>{{1, 2, 0}}));
}

TEST(Topology, ACornerBeforeItsSharedEdgeHasNoParallelogram) {
  // Across the edge 1-3 lie 0 and 2; 2 comes before 3.
  const Topology topology = make_topology(4, Triangles{{0, 1, 3}, {3, 1, 2}});
  for (std::size_t v = 0; v < 4; ++v) EXPECT_TRUE(topology.parallelograms[v].empty());
}

TEST(Topology, EdgesOfThreeTrianglesHaveNoParallelogram) {
  const Topology topology = make_topology(5, Triangles{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  for (std::size_t v = 0; v < 5; ++v) EXPECT_TRUE(topology.parallelograms[v].empty());
}

TEST(Topology, ATriangleListedTwiceHasNoParallelogram) {
  const Topology topology = make_topology(3, Triangles{{0, 1, 2}, {0, 2, 1}});
  for (std::size_t v = 0; v < 3; ++v) EXPECT_TRUE(topology.parallelograms[v].empty());
}

// A literal implementation of 8.3.1 and 8.3.2, with sets and maps.
struct Plain {
  std::vector<std::set<std::uint32_t>> neighbours;
  std::vector<std::multiset<Corners>> parallelograms;
};

Plain plain_topology(std::uint32_t num_vertices, const Triangles& triangles) {
  Plain plain{std::vector<std::set<std::uint32_t>>(num_vertices),
              std::vector<std::multiset<Corners>>(num_vertices)};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> across;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t a : t) {
      for (const std::uint32_t b : t) {
        if (a < b) plain.neighbours[b].insert(a);
      }
    }
    if (std::set<std::uint32_t>(t.begin(), t.end()).size() < 3) continue;
    across[std::minmax(t[0], t[1])].push_back(t[2]);
    across[std::minmax(t[1], t[2])].push_back(t[0]);
    across[std::minmax(t[2], t[0])].push_back(t[1]);
  }
  for (const auto& [edge, corners] : across) {
    if (corners.size() != 2 || corners[0] == corners[1]) continue;
    const auto [c, v] = std::minmax(corners[0], corners[1]);
    if (v > edge.second) plain.parallelograms[v].insert({edge.first, edge.second, c});
  }
  return plain;
}

TEST(Topology, FollowsTheDefinitionOnRandomTriangles) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::uint32_t num_vertices = 1 + static_cast<std::uint32_t>(random() % 30);
    Triangles triangles(random() % 60);
    for (Triangle& t : triangles) {
      for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(random() % num_vertices);
    }
    const Topology topology = make_topology(num_vertices, triangles);
    const Plain plain = plain_topology(num_vertices, triangles);
    for (std::size_t v = 0; v < num_vertices; ++v) {
      ASSERT_EQ(neighbours(topology, v),
                Indices(plain.neighbours[v].begin(), plain.neighbours[v].end()));
      std::multiset<Corners> found;
      for (const Parallelogram& p : topology.parallelograms[v]) found.insert({p.a, p.b, p.c});
      ASSERT_EQ(found, plain.parallelograms[v]);
    }
  }
}

}  // namespace
}  // namespace rlpc
