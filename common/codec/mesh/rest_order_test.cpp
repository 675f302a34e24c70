#include "common/codec/mesh/rest_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

using Triangles = std::vector<Triangle>;

// Makes a sheet with holes, flipped triangles, and stray and degenerate triangles.
Triangles sheet_with_defects(unsigned seed, std::uint32_t num_vertices) {
  std::mt19937 engine(seed);
  const auto random = [&engine] { return static_cast<std::uint32_t>(engine()); };
  const std::uint32_t width = 1 + random() % 7;
  Triangles triangles;
  for (std::uint32_t v = 0; v + width + 1 < num_vertices; ++v) {
    if (random() % 12 != 0) triangles.push_back({v, v + 1, v + width + 1});
    if (random() % 12 != 0) triangles.push_back({v, v + width + 1, v + width});
    if (random() % 12 == 0) std::swap(triangles.back()[0], triangles.back()[1]);
  }
  for (std::uint32_t i = random() % 5; i > 0; --i) {
    triangles.push_back(
        {random() % num_vertices, random() % num_vertices, random() % num_vertices});
  }
  return triangles;
}

// Finds the hinges of 8.18.1 by a search of all pairs of triangles: [low, high, p, q], in
// order.
std::vector<std::array<std::uint32_t, 4>> hinges_of_text(const Triangles& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> corners;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  // in the order of appearance
  for (const Triangle& t : triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = std::minmax(t[(k + 1) % 3], t[(k + 2) % 3]);
      if (corners[edge].empty()) edges.push_back(edge);
      corners[edge].push_back(t[k]);
    }
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::array<std::uint32_t, 4>> hinges;
  for (const auto& edge : edges) {
    const auto& list = corners[edge];
    if (list.size() == 2 && list[0] != list[1]) {
      hinges.push_back({edge.first, edge.second, list[0], list[1]});
    }
  }
  return hinges;
}

bool has_triangle(const Triangles& triangles, std::uint32_t a, std::uint32_t b,
                  std::uint32_t c) {
  return std::any_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
    return t == Triangle{a, b, c} || t == Triangle{b, c, a} || t == Triangle{c, a, b};
  });
}

// 8.18.2: takes the vertex with the most hinges or, of several, the one that has had as many
// for longest.
std::vector<std::uint32_t> order_of_text(const Triangles& triangles,
                                         std::uint32_t num_vertices) {
  const auto hinges = hinges_of_text(triangles);
  std::vector<int> known(hinges.size(), 0);
  std::vector<int> degree(num_vertices, 0);
  std::vector<std::size_t> since(num_vertices, 0);
  std::vector<bool> is_there(num_vertices, false);
  std::vector<std::uint32_t> order;
  std::size_t events = 0;
  while (order.size() < num_vertices) {
    std::uint32_t best = num_vertices;
    for (std::uint32_t v = 0; v < num_vertices; ++v) {
      if (is_there[v]) continue;
      const bool is_better = best == num_vertices || degree[v] > degree[best] ||
                             (degree[v] == degree[best] && since[v] < since[best]);
      if (is_better) best = v;
    }
    is_there[best] = true;
    order.push_back(best);
    for (std::size_t i = 0; i < hinges.size(); ++i) {
      const auto& h = hinges[i];
      if (std::find(h.begin(), h.end(), best) == h.end() || ++known[i] != 3) continue;
      for (const std::uint32_t v : {h[2], h[3]}) {
        if (is_there[v] || degree[v] == 3) continue;
        ++degree[v];
        since[v] = ++events;
      }
    }
  }
  return order;
}

TEST(RestOrder, IsThatOfTheText) {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    const std::uint32_t n = 1 + seed % 60;
    const Triangles triangles = sheet_with_defects(seed, n);
    const RestOrder order(make_topology(n, triangles), triangles);
    const auto expected = order_of_text(triangles, n);
    ASSERT_TRUE(std::equal(expected.begin(), expected.end(), order.order().begin(),
                           order.order().end()));
    for (std::uint32_t i = 0; i < n; ++i) EXPECT_EQ(order.place(expected[i]), i);
  }
}

TEST(RestOrder, HingesAreCompleteAndInTheOrientationOfTheirTriangle) {
  std::size_t count = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const std::uint32_t n = 4 + seed % 60;
    const Triangles triangles = sheet_with_defects(seed, n);
    const RestOrder order(make_topology(n, triangles), triangles);
    const auto all = hinges_of_text(triangles);
    for (std::uint32_t v = 0; v < n; ++v) {
      std::size_t complete = 0;
      for (const auto& h : all) {
        if (v != h[2] && v != h[3]) continue;
        complete += std::all_of(h.begin(), h.end(), [&](std::uint32_t u) {
          return u == v || order.place(u) < order.place(v);
        });
      }
      ASSERT_EQ(order.hinges(v).size(), std::min(complete, kMaxRestHinges));
      for (const Hinge& hinge : order.hinges(v)) {
        EXPECT_TRUE(has_triangle(triangles, v, hinge.a, hinge.b));
        EXPECT_TRUE(has_triangle(triangles, hinge.c, hinge.a, hinge.b) ||
                    has_triangle(triangles, hinge.c, hinge.b, hinge.a));
        const auto back = order.across(hinge);
        ASSERT_TRUE(back);
        EXPECT_EQ(back->vertex, v);
        EXPECT_FALSE(back->mirrored);
        const auto mirrored = order.across({hinge.b, hinge.a, hinge.c});
        ASSERT_TRUE(mirrored);
        EXPECT_EQ(mirrored->vertex, v);
        EXPECT_TRUE(mirrored->mirrored);
        EXPECT_FALSE(order.across({hinge.a, hinge.c, v}) &&
                     order.across({hinge.a, hinge.c, v})->vertex == hinge.b &&
                     !has_triangle(triangles, hinge.b, hinge.a, hinge.c) &&
                     !has_triangle(triangles, hinge.b, hinge.c, hinge.a));
        ++count;
      }
    }
  }
  EXPECT_GT(count, 5000U);
}

TEST(RestOrder, RingsPrecedeTheirVertices) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const std::uint32_t n = 1 + seed % 60;
    const Triangles triangles = sheet_with_defects(seed, n);
    const Topology topology = make_topology(n, triangles);
    const RestOrder order(topology, triangles);
    for (std::uint32_t v = 0; v < n; ++v) {
      const auto ring = order.ring(v);
      ASSERT_LE(ring.size(), kMaxRestRing);
      EXPECT_EQ(ring.empty(), v == 0);
      for (const std::uint32_t u : ring) {
        EXPECT_LT(order.place(u), order.place(v));
        EXPECT_EQ(std::count(ring.begin(), ring.end(), u), 1);
      }
      for (const Hinge& hinge : order.hinges(v)) {
        EXPECT_EQ(std::count(ring.begin(), ring.end(), hinge.a), 1);
        EXPECT_EQ(std::count(ring.begin(), ring.end(), hinge.b), 1);
      }
    }
  }
}

// An edge of three triangles, and two triangles on the same three vertices, are no hinges.
TEST(RestOrder, EdgesOfOtherThanTwoCornersAreNoHinges) {
  const Triangles fin{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const RestOrder fin_order(make_topology(5, fin), fin);
  const Triangles twice{{0, 1, 2}, {1, 0, 2}};
  const RestOrder twice_order(make_topology(3, twice), twice);
  for (std::uint32_t v = 0; v < 5; ++v) EXPECT_TRUE(fin_order.hinges(v).empty());
  for (std::uint32_t v = 0; v < 3; ++v) EXPECT_TRUE(twice_order.hinges(v).empty());
  EXPECT_FALSE(fin_order.across({0, 1, 2}));
  EXPECT_FALSE(twice_order.across({0, 1, 2}));
}

}  // namespace
}  // namespace rlpc
