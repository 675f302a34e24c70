#include "common/codec/rest/counterparts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "common/testing/grid.h"

namespace rlpc {
namespace {

using Triangles = std::vector<Triangle>;
using HingeOfText = std::array<std::int64_t, 3>;

HingeOfText listed(const Hinge& hinge) { return {hinge.a, hinge.b, hinge.c}; }

// The functions of 8.18.4 as they are written; hinges and order are those of the mesh.
class CounterpartsOfText {
 public:
  using Pair = std::pair<HingeOfText, HingeOfText>;

  CounterpartsOfText(const RestOrder& order, const Triangles& triangles)
      : order_(order),
        triangles_(triangles),
        rest_class(order.num_vertices(), 0),
        passed_on(order.num_vertices(), -1),
        counterpart_of(order.num_vertices(), -1),
        mirrored(order.num_vertices(), false),
        pairs(order.num_vertices()) {}

  void inherit(std::uint32_t v) {
    for (const Hinge& hinge : order_.hinges(v)) {
      const std::int64_t a = passed_on[hinge.a];
      const std::int64_t b = passed_on[hinge.b];
      const std::int64_t c = passed_on[hinge.c];
      if (a < 0 || b < 0 || c < 0) continue;
      const auto found = vertex_across(a, b, c);
      if (!found) continue;
      const auto& [w, other] = *found;
      if (order_.place(w) >= order_.place(v)) continue;
      add_pair(v, w, listed(hinge), other, other[0] != a);
    }
  }
  std::size_t context(std::uint32_t v) const {
    std::size_t count = 0;
    for (const std::int64_t u : pairs[v][0].first) {
      count += rest_class[static_cast<std::size_t>(u)] == 1 ? 1U : 0U;
    }
    return count;
  }
  void new_counterpart(std::uint32_t v, const Counterpart& choice) {
    const HingeOfText own = listed(order_.hinges(v)[choice.hinge]);
    const auto& [w, k] = hinge_list[choice.idx];
    const HingeOfText other = listed(order_.hinges(w)[k]);
    pairs[v].clear();
    add_pair(v, w, own, other, choice.mirrored);
    passed_on[static_cast<std::size_t>(own[0])] = other[choice.mirrored ? 1 : 0];
    passed_on[static_cast<std::size_t>(own[1])] = other[choice.mirrored ? 0 : 1];
    passed_on[static_cast<std::size_t>(own[2])] = other[2];
  }
  void end(std::uint32_t v, bool used) {
    if (used) {
      rest_class[v] = 1;
      passed_on[v] = counterpart_of[v];
    } else {
      pairs[v].clear();
      if (order_.hinges(v).empty()) rest_class[v] = 2;
    }
    for (std::uint32_t k = 0; k < order_.hinges(v).size(); ++k) hinge_list.emplace_back(v, k);
  }

 private:
  const RestOrder& order_;
  const Triangles& triangles_;

 public:
  std::vector<int> rest_class;                                      // RestClass
  std::vector<std::int64_t> passed_on;                              // PassedOn
  std::vector<std::int64_t> counterpart_of;                         // CounterpartOf
  std::vector<bool> mirrored;                                       // CounterpartMirrored
  std::vector<std::vector<Pair>> pairs;                             // CounterpartPairs
  std::vector<std::pair<std::uint32_t, std::uint32_t>> hinge_list;  // HingeList

 private:
  // VertexAcross( a, b, c ), by a search of all triangles.
  std::optional<std::pair<std::uint32_t, HingeOfText>> vertex_across(std::int64_t a,
                                                                     std::int64_t b,
                                                                     std::int64_t c) const {
    std::vector<HingeOfText> turned;  // triangles (corner, x, y) with the edge
    for (const Triangle& t : triangles_) {
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int64_t x = t[(k + 1) % 3];
        const std::int64_t y = t[(k + 2) % 3];
        if ((x == a && y == b) || (x == b && y == a)) turned.push_back({t[k], x, y});
      }
    }
    if (turned.size() != 2 || turned[0][0] == turned[1][0]) return std::nullopt;
    for (std::size_t k = 0; k < 2; ++k) {
      if (turned[1 - k][0] != c) continue;
      return std::pair(static_cast<std::uint32_t>(turned[k][0]),
                       HingeOfText{turned[k][1], turned[k][2], c});
    }
    return std::nullopt;
  }
  void add_pair(std::uint32_t v, std::uint32_t w, const HingeOfText& own,
                const HingeOfText& other, bool is_mirrored) {
    if (pairs[v].empty()) {
      counterpart_of[v] = w;
      mirrored[v] = is_mirrored;
    }
    if (counterpart_of[v] == w) pairs[v].emplace_back(own, other);
  }
};

struct Shape {
  Triangles triangles;
  Topology topology;
  RestOrder order;

  Shape(std::uint32_t num_vertices, Triangles list)
      : triangles(std::move(list)),
        topology(make_topology(num_vertices, triangles)),
        order(topology, triangles) {}
};

// Four squares. The order is 0, 1, 2, 3, 5, 4, 6, 7, 8; 3 has the hinge (2, 1, 0), 5 has
// (3, 1, 2), 4 has (2, 3, 1), 6 has (3, 5, 1), and 7 has (4, 3, 2) and (3, 6, 5).
struct Squares : Shape {
  Counterparts counterparts{order};

  Squares()
      : Shape(9, {{0, 1, 2},
                  {2, 1, 3},
                  {2, 3, 4},
                  {3, 1, 5},
                  {3, 5, 6},
                  {3, 6, 7},
                  {3, 7, 4},
                  {7, 6, 8}}) {}
  void skip(std::initializer_list<std::uint32_t> vertices) {
    for (const std::uint32_t v : vertices) {
      counterparts.start(v);
      counterparts.finish(false);
    }
  }
};

void expect_pair(const HingePair& pair, const HingeOfText& own, const HingeOfText& other,
                 bool mirrored) {
  EXPECT_EQ(listed(pair.own), own);
  EXPECT_EQ(listed(pair.other), other);
  EXPECT_EQ(pair.mirrored, mirrored);
}

TEST(Counterparts, StartWithoutAny) {
  Squares squares;
  for (std::uint32_t v = 0; v < 9; ++v) {
    EXPECT_EQ(squares.counterparts.passed_on(v), Counterparts::kNone);
    EXPECT_EQ(squares.counterparts.class_of(v), RestClass::kHinges);
  }
  EXPECT_EQ(squares.counterparts.num_listed(), 0U);
  squares.skip({0, 1, 2});
  EXPECT_EQ(squares.counterparts.num_listed(), 0U);
  EXPECT_EQ(squares.counterparts.class_of(0), RestClass::kNoHinge);
  squares.skip({3, 5});
  EXPECT_EQ(squares.counterparts.num_listed(), 2U);
  EXPECT_EQ(squares.counterparts.class_of(3), RestClass::kHinges);
  EXPECT_FALSE(squares.counterparts.is_inherited());
}

// Vertex 4 takes 3 as its mirrored counterpart: 2 of its hinge (2, 3, 1) corresponds to 1 of
// (2, 1, 0), 3 to 2 and 1 to 0. Vertex 7 inherits from that: 4, 3 and 2 correspond to 3, 2 and
// 1, across whose edge is 4, in the other orientation.
TEST(Counterparts, AreInheritedAcrossHinges) {
  Squares squares;
  Counterparts& counterparts = squares.counterparts;
  squares.skip({0, 1, 2, 3, 5});
  counterparts.start(4);
  ASSERT_FALSE(counterparts.is_inherited());
  const Counterpart choice{false, true, true, 0, 0};
  const HingePairs tried = counterparts.new_pairs(choice);
  EXPECT_EQ(tried.size, 1U);
  EXPECT_EQ(tried.counterpart, 3U);
  EXPECT_FALSE(counterparts.is_inherited());
  EXPECT_EQ(counterparts.passed_on(1), Counterparts::kNone);
  counterparts.set_new(choice);
  EXPECT_TRUE(counterparts.is_inherited());
  expect_pair(counterparts.pairs().list[0], {2, 3, 1}, {2, 1, 0}, true);
  EXPECT_EQ(counterparts.passed_on(2), 1U);
  EXPECT_EQ(counterparts.passed_on(3), 2U);
  EXPECT_EQ(counterparts.passed_on(1), 0U);
  EXPECT_EQ(counterparts.passed_on(4), Counterparts::kNone);
  counterparts.finish(true);
  EXPECT_EQ(counterparts.passed_on(4), 3U);
  EXPECT_EQ(counterparts.class_of(4), RestClass::kCounterpart);

  counterparts.start(6);  // 5 passes on none
  EXPECT_FALSE(counterparts.is_inherited());
  counterparts.finish(false);
  counterparts.start(7);
  ASSERT_TRUE(counterparts.is_inherited());
  EXPECT_EQ(counterparts.pairs().size, 1U);
  EXPECT_EQ(counterparts.pairs().counterpart, 4U);
  expect_pair(counterparts.pairs().list[0], {4, 3, 2}, {2, 3, 1}, true);
  EXPECT_EQ(counterparts.context(), 1U);  // 4 of 4, 3 and 2
  counterparts.finish(true);
  EXPECT_EQ(counterparts.passed_on(7), 4U);
  EXPECT_EQ(counterparts.num_listed(), 6U);
  squares.skip({8});
  EXPECT_EQ(counterparts.num_listed(), 7U);
}

// Vertex 2 corresponds to 2, 3 to 1 and 1 to 0.
TEST(Counterparts, KeepTheirOrientationUnlessTheyAreMirrored) {
  Squares squares;
  squares.skip({0, 1, 2, 3, 5});
  squares.counterparts.start(4);
  squares.counterparts.set_new({false, true, false, 0, 0});
  expect_pair(squares.counterparts.pairs().list[0], {2, 3, 1}, {2, 1, 0}, false);
  EXPECT_EQ(squares.counterparts.passed_on(2), 2U);
  EXPECT_EQ(squares.counterparts.passed_on(3), 1U);
  EXPECT_EQ(squares.counterparts.passed_on(1), 0U);
}

TEST(Counterparts, ThatAreNotUsedAreNotPassedOn) {
  Squares squares;
  Counterparts& counterparts = squares.counterparts;
  squares.skip({0, 1, 2, 3, 5});
  counterparts.start(4);
  counterparts.set_new({false, true, true, 0, 0});
  counterparts.finish(true);
  squares.skip({6});
  counterparts.start(7);
  ASSERT_TRUE(counterparts.is_inherited());
  counterparts.finish(false);
  EXPECT_EQ(counterparts.passed_on(7), Counterparts::kNone);
  EXPECT_EQ(counterparts.class_of(7), RestClass::kHinges);
}

// 8.18.4: pairs are all hinges that lead to the same earlier vertex as the first of them.
TEST(Counterparts, PairsLeadToTheVertexOfTheFirst) {
  const Squares squares;
  const auto pairs_of_7 = [&](const std::vector<std::uint32_t>& passed_on) {
    return inherited_pairs(squares.order, 7, [&](std::uint32_t u) { return passed_on[u]; });
  };
  constexpr std::uint32_t kNo = Counterparts::kNone;
  // Both (4, 3, 2) and (3, 6, 5) lead to vertex 5 with its hinge (3, 1, 2).
  const HingePairs both = pairs_of_7({kNo, kNo, 2, 1, 3, 2, 3, kNo, kNo});
  ASSERT_EQ(both.size, 2U);
  EXPECT_EQ(both.counterpart, 5U);
  expect_pair(both.list[0], {4, 3, 2}, {3, 1, 2}, false);
  expect_pair(both.list[1], {3, 6, 5}, {3, 1, 2}, true);
  // The second, (3, 6, 5), leads to (1, 2, 0) and vertex 3.
  const HingePairs first = pairs_of_7({kNo, kNo, 2, 1, 3, 0, 2, kNo, kNo});
  ASSERT_EQ(first.size, 1U);
  EXPECT_EQ(first.counterpart, 5U);
  // The first has no counterpart.
  const HingePairs second = pairs_of_7({kNo, kNo, kNo, 1, 3, 0, 2, kNo, kNo});
  ASSERT_EQ(second.size, 1U);
  EXPECT_EQ(second.counterpart, 3U);
  expect_pair(second.list[0], {3, 6, 5}, {2, 1, 0}, true);
  // Vertices that come later, the vertex itself, and triples that are no hinges do not count.
  EXPECT_EQ(pairs_of_7({kNo, kNo, 3, 6, 7, kNo, kNo, kNo, kNo}).size, 0U);
  EXPECT_EQ(pairs_of_7({kNo, kNo, 2, 3, 4, kNo, kNo, kNo, kNo}).size, 0U);
  EXPECT_EQ(pairs_of_7({kNo, kNo, 0, 1, 2, 0, 6, kNo, kNo}).counterpart, 3U);
  EXPECT_EQ(pairs_of_7({kNo, kNo, 3, 1, 0, kNo, kNo, kNo, kNo}).size, 0U);
}

// Grids that are closed or not, some triangles of which are turned over or missing.
Shape random_shape(std::mt19937& random) {
  const std::uint32_t width = 2 + static_cast<std::uint32_t>(random() % 6);
  const std::uint32_t height = 2 + static_cast<std::uint32_t>(random() % 6);
  Triangles triangles;
  for (Triangle t : grid_triangles(width, height, random() % 2 == 0)) {
    if (random() % 25 == 0) continue;
    if (random() % 25 == 0) std::swap(t[0], t[1]);
    triangles.push_back(t);
  }
  return {width * height, triangles};
}

TEST(RandomCounterparts, AreThoseOfTheText) {
  std::array<int, 4> contexts{};
  int num_mirrored = 0;
  int num_several = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const Shape shape = random_shape(random);
    CounterpartsOfText text(shape.order, shape.triangles);
    Counterparts counterparts(shape.order);
    for (const std::uint32_t v : shape.order.order()) {
      text.inherit(v);
      counterparts.start(v);
      ASSERT_EQ(counterparts.is_inherited(), !text.pairs[v].empty());
      bool used = false;
      if (counterparts.is_inherited()) {
        ASSERT_EQ(counterparts.context(), text.context(v));
        ++contexts[counterparts.context()];
        used = random() % 8 != 0;
      }
      ASSERT_EQ(counterparts.num_listed(), text.hinge_list.size());
      const std::size_t hinges = shape.order.hinges(v).size();
      if (!used && hinges > 0 && !text.hinge_list.empty() && random() % 3 == 0) {
        Counterpart choice;
        choice.new_flag = true;
        choice.hinge = static_cast<std::uint8_t>(random() % hinges);
        choice.idx = static_cast<std::uint32_t>(random() % text.hinge_list.size());
        choice.mirrored = random() % 2 == 0;
        text.new_counterpart(v, choice);
        counterparts.set_new(choice);
        used = true;
      }
      const HingePairs& pairs = counterparts.pairs();
      if (used) {
        ASSERT_EQ(pairs.size, text.pairs[v].size());
        ASSERT_EQ(pairs.counterpart, text.counterpart_of[v]);
        for (std::size_t i = 0; i < pairs.size; ++i) {
          ASSERT_EQ(listed(pairs.list[i].own), text.pairs[v][i].first);
          ASSERT_EQ(listed(pairs.list[i].other), text.pairs[v][i].second);
        }
        ASSERT_EQ(pairs.list[0].mirrored, text.mirrored[v]);
        num_mirrored += text.mirrored[v] ? 1 : 0;
        num_several += pairs.size > 1 ? 1 : 0;
      }
      text.end(v, used);
      counterparts.finish(used);
      for (std::uint32_t u = 0; u < shape.order.num_vertices(); ++u) {
        const std::uint32_t passed_on = counterparts.passed_on(u);
        ASSERT_EQ(passed_on == Counterparts::kNone ? -1 : std::int64_t{passed_on},
                  text.passed_on[u]);
      }
      ASSERT_EQ(static_cast<int>(counterparts.class_of(v)), text.rest_class[v]);
    }
  }
  for (const int count : contexts) EXPECT_GT(count, 20);
  EXPECT_GT(num_mirrored, 300);
  EXPECT_GT(num_several, 60);
}

}  // namespace
}  // namespace rlpc
