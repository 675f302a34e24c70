#include "decoder/report/group_colours.h"

#include <gtest/gtest.h>

#include <numeric>

namespace rlpc {
namespace {

double min_distance(const std::vector<Colour>& colours) {
  double min = 1;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      min = std::min(min, colour_distance(colours[i], colours[j]));
  }
  return min;
}

std::vector<std::uint32_t> one_each(std::uint32_t num_groups) {
  std::vector<std::uint32_t> group_of_vertex(num_groups);
  std::iota(group_of_vertex.begin(), group_of_vertex.end(), 0U);
  return group_of_vertex;
}

TEST(GroupColours, AreAllDifferentUpToThirtySix) {
  std::vector<Triangle> all;  // all groups are neighbours of each other
  for (std::uint32_t a = 0; a < 36; ++a) {
    for (std::uint32_t b = 0; b < a; ++b) all.push_back({a, b, b});
  }
  EXPECT_GT(min_distance(group_colours(36, one_each(36), {})), 0.06);
  EXPECT_GT(min_distance(group_colours(36, one_each(36), all)), 0.06);
  EXPECT_EQ(min_distance(group_colours(37, one_each(37), {})), 0);
}

TEST(GroupColours, AreDistinctInNeighbours) {
  // A grid with a group per vertex: no vertex has more than six neighbours.
  constexpr std::uint32_t kSide = 30;
  std::vector<Triangle> triangles;
  for (std::uint32_t v = 0; v + kSide < kSide * kSide; ++v) {
    if (v % kSide == kSide - 1) continue;
    triangles.push_back({v, v + 1, v + kSide + 1});
    triangles.push_back({v, v + kSide + 1, v + kSide});
  }
  const auto colours = group_colours(kSide * kSide, one_each(kSide * kSide), triangles);
  for (const Triangle& t : triangles) {
    EXPECT_GE(colour_distance(colours[t[0]], colours[t[1]]), 0.11);
    EXPECT_GE(colour_distance(colours[t[1]], colours[t[2]]), 0.11);
    EXPECT_GE(colour_distance(colours[t[2]], colours[t[0]]), 0.11);
  }
}

TEST(GroupColours, OfARampGetLighter) {
  for (const std::uint32_t count : {2U, 9U, 212U}) {
    const std::vector<Colour> colours = ramp_colours(count);
    ASSERT_EQ(colours.size(), count);
    for (std::uint32_t i = 1; i < count; ++i) {
      EXPECT_GT(colours[i][0], colours[i - 1][0]);
      EXPECT_NE(colour_text(colours[i]), colour_text(colours[i - 1])) << i << " of " << count;
    }
  }
  EXPECT_EQ(ramp_colours(1).size(), 1U);
}

// The coordinates of red are those published by the author of OKLab.
TEST(GroupColours, AreWrittenAsSrgb) {
  EXPECT_EQ(colour_text({0, 0, 0}), "#000000");
  EXPECT_EQ(colour_text({1, 0, 0}), "#ffffff");
  EXPECT_EQ(colour_text({0.62796, 0.22486, 0.12585}), "#ff0000");
  EXPECT_EQ(colour_text({1, 0, 0}, 0), "#b1b1b1") << "76 % of the lightness";
  EXPECT_EQ(colour_text({1, 0.3, 0.3}).size(), 7U) << "not in sRGB";
}

}  // namespace
}  // namespace rlpc
