#include "decoder/report/group_picture.h"

#include <gtest/gtest.h>

#include <regex>

namespace rlpc {
namespace {

struct Path {
  std::string class_name;
  std::string d;
  bool operator==(const Path&) const = default;
};

std::vector<Path> paths_of(const std::string& svg) {
  static const std::regex kPath("<path class=\"(\\w+)\" [^>]*d=\"([^\"]*)\"/>");
  std::vector<Path> paths;
  for (std::sregex_iterator i(svg.begin(), svg.end(), kPath), end; i != end; ++i)
    paths.push_back({(*i)[1], (*i)[2]});
  return paths;
}

// Square of two triangles, and a hidden square behind it.
const std::vector<Point> kPoints{{0, 0, 5},   {60, 0, 5},  {60, 60, 5}, {0, 60, 5},
                                 {10, 10, 1}, {50, 10, 1}, {50, 50, 1}};
const CoarseMesh kMesh{{0, 1, 2, 3, 4, 5, 6}, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}}};
const std::vector<std::uint32_t> kGroup{0, 0, 0, 1, 2, 2, 2};

TEST(GroupPicture, CornersOfDifferentGroupsHaveTheirParts) {
  const std::vector<Colour> colours = ramp_colours(3);
  const std::string svg = group_picture(kMesh, kPoints, {kGroup, colours, {}}, 7, 8);
  const std::vector<Path> expected{{"g2", "M10.0 10.0L50.0 10.0L50.0 50.0Z"},
                                   {"g0", "M0.0 0.0L60.0 0.0L60.0 60.0Z"},
                                   {"g0", "M0.0 0.0L30.0 30.0L20.0 40.0L0.0 30.0Z"},
                                   {"g0", "M60.0 60.0L30.0 60.0L20.0 40.0L30.0 30.0Z"},
                                   {"g1", "M0.0 60.0L0.0 30.0L20.0 40.0L30.0 60.0Z"}};
  EXPECT_EQ(paths_of(svg), expected);
  EXPECT_NE(svg.find("translate(7.0 8.0)"), std::string::npos);
  for (std::size_t group = 0; group < 3; ++group) {  // seen from the front: the colour itself
    const std::string start = "<path class=\"g" + std::to_string(group) + "\" color=\"";
    EXPECT_NE(svg.find(start + colour_text(colours[group]) + "\""), std::string::npos);
  }
}

TEST(GroupPicture, SurfacesSeenFromTheSideAreDarker) {
  const std::vector<Point> points{{0, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  const std::vector<Colour> colours = ramp_colours(1);
  const std::string svg =
      group_picture({{0, 1, 2}, {{0, 1, 2}}}, points,
                    {std::vector<std::uint32_t>{0, 0, 0}, colours, {}}, 0, 0);
  EXPECT_NE(svg.find("\"" + colour_text(colours[0], 0) + "\""), std::string::npos);
}

TEST(GroupPicture, SeedsAreInFrontOfTheirSurfaceButHiddenByOthers) {
  const std::vector<Colour> colours = ramp_colours(3);
  std::vector<Point> points = kPoints;
  for (std::size_t v = 0; v < 4; ++v) points[v][2] = 500;
  const std::vector<std::array<std::uint32_t, 3>> seeds{{0, 1, 2}, {4, 5, 6}};
  const std::vector<Path> paths =
      paths_of(group_picture(kMesh, points, {kGroup, colours, seeds}, 0, 0));
  ASSERT_EQ(paths.size(), 9U);
  const auto is_seed = [&](std::size_t i, std::size_t surface) {
    return paths[i] == Path{"seed", paths[surface].d};
  };
  EXPECT_TRUE(is_seed(1, 0) && is_seed(2, 0)) << "before the square";
  EXPECT_TRUE(is_seed(7, 3) && is_seed(8, 3)) << "after both of its triangles";
}

TEST(GroupPicture, WithoutTrianglesThereAreDots) {
  const std::vector<Colour> colours = ramp_colours(3);
  const CoarseMesh some{{6, 3}, {}};
  const std::string svg = group_picture(some, kPoints, {kGroup, colours, {}}, 0, 0);
  const std::vector<Path> expected{{"g2", "M50.0 50.0h0"}, {"g1", "M0.0 60.0h0"}};
  EXPECT_EQ(paths_of(svg), expected);
  EXPECT_NE(svg.find("stroke-linecap=\"round\""), std::string::npos) << "others are invisible";
}

}  // namespace
}  // namespace rlpc
