#include "common/codec/rest/rest_contexts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "common/testing/grid.h"

namespace rlpc {
namespace {

using Residual = std::array<std::int32_t, kRestFactors>;

// Computes expected magnitudes as 9.8.5 is written.
class RestContextsOfText {
 public:
  explicit RestContextsOfText(const RestOrder& order)
      : rest_class(order.num_vertices(), 0), order_(order) {
    for (auto& class_means : rest_mean_) class_means.fill(256);
    for (auto& magnitudes : magnitude_) magnitudes.assign(order.num_vertices(), 0);
  }

  std::vector<std::size_t> rest_class;

  void start(std::uint32_t v) {
    latest_mean_ = 0;
    for (std::size_t l = 0; l < 3; ++l) {
      std::int64_t sum = 0;
      std::int64_t count = 0;
      for (const std::uint32_t u : order_.ring(v)) {
        if (rest_class[u] != rest_class[v]) continue;
        sum += magnitude_[l][u];
        ++count;
      }
      ring_mean_[l] = count == 0 ? rest_mean_[rest_class[v]][l] : sum * 256 / count;
    }
  }
  std::int64_t expected(std::size_t l, std::uint32_t v) const {
    return (96 * rest_mean_[rest_class[v]][l] + 88 * ring_mean_[l] + 72 * latest_mean_) / 4096;
  }
  void update(std::size_t l, std::uint32_t v, std::int32_t residual) {
    const std::int64_t magnitude = std::abs(residual);
    latest_mean_ = updated(latest_mean_, magnitude, 4);
    rest_mean_[rest_class[v]][l] = updated(rest_mean_[rest_class[v]][l], magnitude, 32);
    magnitude_[l][v] = std::min<std::int64_t>(magnitude, 255);
  }

 private:
  // 9.5.3: magnitudes are clipped to 2^20; steps are rounded towards the mean.
  static std::int64_t updated(std::int64_t mean, std::int64_t magnitude, std::int64_t parts) {
    return mean + (std::min<std::int64_t>(magnitude, 1 << 20) * 256 - mean) / parts;
  }

  const RestOrder& order_;
  std::array<std::array<std::int64_t, 3>, 3> rest_mean_{};
  std::array<std::vector<std::int64_t>, 3> magnitude_;
  std::array<std::int64_t, 3> ring_mean_{};
  std::int64_t latest_mean_ = 0;
};

// Two triangles with the edge (1, 2): 1 follows 0, the ring of 2 is 0 and 1, and 3 has the
// hinge (2, 1, 0), whose edge is its ring.
struct Hinged {
  std::vector<Triangle> triangles{{0, 1, 2}, {2, 1, 3}};
  Topology topology = make_topology(4, triangles);
  RestOrder order{topology, triangles};
  Counterparts counterparts{order};
  RestContexts contexts{order};

  // Returns the expected magnitudes of the residuals of a vertex.
  std::array<std::uint32_t, 3> add(std::uint32_t v, const Residual& residual) {
    counterparts.start(v);
    counterparts.finish(false);
    contexts.start(v, counterparts.class_of(v), counterparts);
    std::array<std::uint32_t, 3> expected{};
    for (std::size_t c = 0; c < 3; ++c) {
      expected[c] = contexts.expected(c);
      contexts.update(c, residual[c]);
    }
    return expected;
  }
};

// Magnitudes of the running mean, the ring and the axes before have the weights 96, 88 and 72
// of 256; expected magnitudes have 4 fractional bits.
TEST(RestContexts, ExpectTheMeanOfThreeMagnitudes) {
  Hinged hinged;
  // Running means are 1; those of the axes before are 0, 5 / 4 and 3 / 4 of that.
  const auto first = hinged.add(0, {5, 0, -2});
  EXPECT_EQ(first[0], 11U);  // 16 * 184 / 256 = 11.5
  EXPECT_EQ(first[1], 17U);  // 16 * (184 + 72 * 1.25) / 256 = 17.1
  EXPECT_EQ(first[2], 15U);  // 0.9375 of the axes before: 15.7
  // Running means are 1 + 4 / 32, 1 - 1 / 32 and 1 + 1 / 32; the ring is vertex 0.
  const auto second = hinged.add(1, {0, 0, 0});
  EXPECT_EQ(second[0], 34U);  // 16 * (96 * 1.125 + 88 * 5) / 256 = 34.25
  EXPECT_EQ(second[1], 5U);   // 16 * 96 * 0.96875 / 256 = 5.8
  EXPECT_EQ(second[2], 17U);  // 16 * (96 * 1.03125 + 88 * 2) / 256 = 17.2
}

// Vertex 3 has a hinge, and those around it have none: its running mean takes their place.
TEST(RestContexts, RingsCountVerticesOfTheSameClass) {
  Hinged hinged;
  hinged.add(0, {200, 0, 0});
  hinged.add(1, {200, 0, 0});
  hinged.add(2, {200, 0, 0});
  EXPECT_EQ(hinged.counterparts.class_of(2), RestClass::kNoHinge);
  const auto last = hinged.add(3, {0, 0, 0});
  EXPECT_EQ(hinged.counterparts.class_of(3), RestClass::kHinges);
  EXPECT_EQ(last[0], 11U);
}

// The mean of the ring of 2 is (255 + 0) / 2 = 127.5, with 8 fractional bits.
TEST(RestContexts, MagnitudesOfTheRingAreClipped) {
  Hinged hinged;
  hinged.add(0, {-100000, 0, 0});
  const std::uint32_t mean = hinged.contexts.means()[2][0];
  EXPECT_EQ(mean, 256 + ((100000 - 1) * 256U) / 32);
  const auto second = hinged.add(1, {0, 0, 0});
  EXPECT_EQ(second[0], (96 * std::uint64_t{mean} + 88 * 255 * 256) / 4096);
  const std::uint32_t later = hinged.contexts.means()[2][0];
  const auto third = hinged.add(2, {0, 0, 0});
  EXPECT_EQ(third[0], (96 * std::uint64_t{later} + 88 * 32640) / 4096);
}

TEST(RestContexts, ClassesHaveMeansOfTheirOwn) {
  Hinged hinged;
  hinged.add(0, {33, 1, 1});
  const RestContexts::Means means = hinged.contexts.means();
  EXPECT_EQ(means[static_cast<std::size_t>(RestClass::kNoHinge)],
            (std::array<std::uint32_t, 3>{512, 256, 256}));
  EXPECT_EQ(means[static_cast<std::size_t>(RestClass::kHinges)],
            (std::array<std::uint32_t, 3>{256, 256, 256}));
  EXPECT_EQ(means[static_cast<std::size_t>(RestClass::kCounterpart)],
            (std::array<std::uint32_t, 3>{256, 256, 256}));
}

TEST(RestContexts, MeansCanBeSetBack) {
  Hinged hinged;
  const RestContexts::Means before = hinged.contexts.means();
  const auto first = hinged.add(0, {50, 60, 70});
  hinged.contexts.set_means(before);
  hinged.contexts.start(0, RestClass::kNoHinge, hinged.counterparts);
  EXPECT_EQ(hinged.contexts.expected(0), first[0]);
}

// Residuals have any size, and vertices any class.
TEST(RandomRestContexts, AreThoseOfTheText) {
  std::array<int, 3> classes{};
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t n) {
      return static_cast<std::uint32_t>(random() % n);
    };
    const std::uint32_t width = 2 + below(6);
    const std::uint32_t height = 2 + below(6);
    const std::vector<Triangle> triangles =
        grid_triangles(width, height, width > 2 && height > 2 && below(2) == 0);
    const Topology topology = make_topology(width * height, triangles);
    const RestOrder order(topology, triangles);
    RestContextsOfText text(order);
    RestContexts contexts(order);
    Counterparts counterparts(order);
    const std::uint32_t max_bits = seed % 3 == 0 ? 28 : 9;
    for (const std::uint32_t v : order.order()) {
      counterparts.start(v);
      bool used = false;
      if (!order.hinges(v).empty() && counterparts.num_listed() > 0 && below(2) == 0) {
        counterparts.set_new({false, true, false, 0,
                              below(static_cast<std::uint32_t>(counterparts.num_listed()))});
        used = true;
      }
      counterparts.finish(used);
      const RestClass rest_class = counterparts.class_of(v);
      text.rest_class[v] = static_cast<std::size_t>(rest_class);
      ++classes[text.rest_class[v]];
      contexts.start(v, rest_class, counterparts);
      text.start(v);
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(contexts.expected(c), text.expected(c, v)) << v << ' ' << c;
        auto residual = static_cast<std::int32_t>(random() & ((1U << below(max_bits + 1)) - 1));
        if (seed % 3 == 0 && below(6) == 0) residual = (1 << 28) - 1;
        if (below(2) == 0) residual = -residual;
        contexts.update(c, residual);
        text.update(c, v, residual);
      }
    }
  }
  for (const int count : classes) EXPECT_GT(count, 300);
}

TEST(RestClasses, AreNumberedAsInTheText) {
  EXPECT_EQ(static_cast<int>(RestClass::kHinges), 0);
  EXPECT_EQ(static_cast<int>(RestClass::kCounterpart), 1);
  EXPECT_EQ(static_cast<int>(RestClass::kNoHinge), 2);
  EXPECT_EQ(RestModels{}.size(), 3U);
  EXPECT_EQ(CounterpartModels{}.counterpart_flag.size(), 4U);
  EXPECT_EQ(CounterpartModels{}.new_counterpart_flag.size(), 2U);
}

}  // namespace
}  // namespace rlpc
