#include "encoder/meshes/polygons/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "encoder/meshes/obj/obj_reader.h"
#include "encoder/meshes/off/off_reader.h"
#include "encoder/meshes/ply/ply_reader.h"

namespace rlpc {
namespace {

using Point = std::array<std::int64_t, 2>;
using Outline = std::vector<Point>;
using Corners = std::vector<std::array<double, 3>>;
using Random = std::mt19937;

std::uint32_t below(Random& random, std::size_t count) {
  return static_cast<std::uint32_t>(random() % count);
}

// Returns twice the area, exactly; below 0 if it turns clockwise.
std::int64_t twice_area(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

std::int64_t twice_area(const Outline& outline) {
  std::int64_t area = 0;
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) {
    area += twice_area(outline[0], outline[i], outline[i + 1]);
  }
  return area;
}

// Places an outline in a plane of space, with coordinates that floats represent exactly.
Corners placed(const Outline& outline, const std::array<std::array<int, 3>, 2>& axes) {
  Corners corners;
  for (const Point& p : outline) {
    std::array<double, 3> corner{};
    for (std::size_t c = 0; c < 3; ++c) {
      corner[c] = static_cast<double>(3 + p[0] * axes[0][c] + p[1] * axes[1][c]);
    }
    corners.push_back(corner);
  }
  return corners;
}

std::vector<PolygonTriangle> triangles_of(const Corners& corners) {
  auto triangles = split_polygon(corners);
  for (std::uint32_t i = 1; triangles.size() + 2 < corners.size(); ++i) {
    triangles.push_back({0, i, i + 1});
  }
  return triangles;
}

// Returns what is wrong with triangles. If all turn the same way, and their edges are those of
// the outline once those that go there and back are removed, they cover each point of it once.
std::string find_fault(const Outline& outline, const std::vector<PolygonTriangle>& triangles) {
  if (triangles.size() + 2 != outline.size()) return "not n - 2 triangles";
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::int64_t area = 0;
  for (const PolygonTriangle& t : triangles) {
    const std::int64_t part = twice_area(outline[t[0]], outline[t[1]], outline[t[2]]);
    if (part < 0) return "a triangle is turned over";
    area += part;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k];
      const std::uint32_t to = t[(k + 1) % 3];
      from < to ? ++edges[{from, to}] : --edges[{to, from}];
    }
  }
  if (area != twice_area(outline)) return "another area";
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    i < next ? --edges[{i, next}] : ++edges[{next, i}];
  }
  for (const auto& [edge, count] : edges) {
    if (count != 0) return "other edges than the outline";
  }
  return "";
}

void expect_covered(const Outline& outline, Random& random, const std::string& name) {
  static constexpr std::array<std::array<std::array<int, 3>, 2>, 5> kPlanes{{
      {{{1, 0, 0}, {0, 1, 0}}},
      {{{0, 1, 0}, {0, 0, 1}}},
      {{{1, 0, 1}, {0, -1, 2}}},
      {{{1, 2, -2}, {2, 1, 2}}},
      {{{3, -1, 7}, {-2, 5, 1}}},
  }};
  Outline turned = outline;
  std::rotate(turned.begin(), turned.begin() + below(random, turned.size()), turned.end());
  for (const auto& plane : kPlanes) {
    const auto triangles = triangles_of(placed(turned, plane));
    const std::string fault = find_fault(turned, triangles);
    std::string text;
    for (const Point& p : turned) {
      text += " " + std::to_string(p[0]) + "," + std::to_string(p[1]);
    }
    ASSERT_EQ(fault, "") << name << text;
  }
}

bool cross(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto side = [](const Point& p, const Point& q, const Point& r) {
    const std::int64_t area = twice_area(p, q, r);
    return area > 0 ? 1 : area < 0 ? -1 : 0;
  };
  return side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
}

// Returns random points, joined in an order that is changed until no edges cross.
Outline untangled(Random& random, std::size_t n, std::int64_t size) {
  Outline points;
  while (points.size() < n) {
    const Point p{below(random, static_cast<std::size_t>(size)),
                  below(random, static_cast<std::size_t>(size))};
    if (std::find(points.begin(), points.end(), p) == points.end()) points.push_back(p);
  }
  for (int round = 0; round < 2000; ++round) {
    bool changed = false;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + 2; j < n; ++j) {
        if (i == 0 && j == n - 1) continue;
        if (!cross(points[i], points[i + 1], points[j], points[(j + 1) % n])) continue;
        std::reverse(points.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                     points.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        changed = true;
      }
    }
    if (changed) continue;
    if (twice_area(points) < 0) std::reverse(points.begin(), points.end());
    return twice_area(points) > 0 ? points : Outline{{0, 0}, {1, 0}, {0, 1}};
  }
  return {{0, 0}, {1, 0}, {0, 1}};  // points on one line
}

// Squares of a grid, joined along the edges of a tree: the walk around them touches itself
// wherever squares are neighbours and not joined, goes around holes, and has corners on
// straight lines. Its area is the number of squares.
class SquareTree {
 public:
  SquareTree(Random& random, std::size_t count) {
    joined_[{0, 0}] = {};
    while (joined_.size() < count) {
      auto at = joined_.begin();
      std::advance(at, below(random, joined_.size()));
      const std::size_t side = below(random, 4);
      const Point next = neighbour(at->first, side);
      if (joined_.contains(next)) continue;
      at->second[side] = true;
      joined_[next][(side + 2) % 4] = true;
    }
    walk({0, 0}, 0, 4);
  }
  const Outline& outline() const { return outline_; }

 private:
  // Sides: below, right, above, left; each begins at the corner with its number.
  static Point neighbour(const Point& p, std::size_t side) {
    static constexpr std::array<Point, 4> kStep{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
    return {p[0] + kStep[side][0], p[1] + kStep[side][1]};
  }
  void walk(const Point& p, std::size_t first_side, std::size_t count) {
    static constexpr std::array<Point, 4> kCorner{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t side = (first_side + i) % 4;
      if (joined_[p][side]) {
        walk(neighbour(p, side), (side + 3) % 4, 3);
      } else {
        outline_.push_back({p[0] + kCorner[side][0], p[1] + kCorner[side][1]});
      }
    }
  }

  std::map<Point, std::array<bool, 4>> joined_;
  Outline outline_;
};

// Returns an outline without some of the corners that lie on straight lines.
Outline without_straight_corners(const Outline& outline, Random& random) {
  Outline kept;
  const std::size_t n = outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Point& a = outline[(i + n - 1) % n];
    const Point& b = outline[i];
    const Point& c = outline[(i + 1) % n];
    const bool goes_on = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]) > 0;
    if (twice_area(a, b, c) == 0 && goes_on && below(random, 2) == 0) continue;
    kept.push_back(b);
  }
  return kept;
}

TEST(Polygon, LeavesConvexOnesAsFans) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    // A convex outline with corners on its edges: sorted by angle on a parabola and its chord.
    Outline outline;
    const std::int64_t n = 2 + below(random, 20);
    for (std::int64_t x = -n; x <= n; ++x) outline.push_back({x, x * x});
    for (std::int64_t x = n - 1; x > -n; --x) {
      if (below(random, 2) == 0) outline.push_back({x, n * n});
    }
    std::rotate(outline.begin(), outline.begin() + below(random, outline.size()),
                outline.end());
    EXPECT_TRUE(split_polygon(placed(outline, {{{1, 0, 2}, {0, 1, -1}}})).empty());
  }
  // This one is not flat, yet convex as seen along its normal.
  EXPECT_TRUE(split_polygon(Corners{{0, 0, 0}, {1, 0, 0.3}, {1, 1, 0}, {0, 1, 0.3}}).empty());
}

TEST(Polygon, CoversAnL) {
  const Outline l{{2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 0}, {2, 0}};
  Random random(2);
  for (int i = 0; i < 20; ++i) expect_covered(l, random, "L");
}

TEST(Polygon, CoversRandomOutlines) {
  Random random(3);
  for (int i = 0; i < 4000 && !HasFatalFailure(); ++i) {
    const std::int64_t size = i % 3 == 0 ? 6 : 1000;
    expect_covered(untangled(random, 4 + below(random, 9), size), random, "untangled");
  }
  for (int i = 0; i < 20 && !HasFatalFailure(); ++i) {
    expect_covered(untangled(random, 60, 10000), random, "large");
  }
}

TEST(Polygon, CoversOutlinesThatTouchThemselvesAndGoAroundHoles) {
  Random random(4);
  for (int i = 0; i < 3000 && !HasFatalFailure(); ++i) {
    const SquareTree tree(random, 2 + below(random, i % 10 == 0 ? 60 : 12));
    expect_covered(tree.outline(), random, "squares");
    expect_covered(without_straight_corners(tree.outline(), random), random, "squares");
  }
}

TEST(Polygon, CoversOutlinesWithCornersTwice) {
  Random random(5);
  for (int i = 0; i < 1000 && !HasFatalFailure(); ++i) {
    Outline outline = untangled(random, 4 + below(random, 6), 30);
    for (int k = 0; k < 3; ++k) {
      const auto at = outline.begin() + below(random, outline.size());
      outline.insert(at, *at);
    }
    expect_covered(outline, random, "twice");
  }
}

TEST(Polygon, CoversSpiralsAndCombsOfThousands) {
  Random random(6);
  Outline comb;
  for (std::int64_t i = 0; i < 1500; ++i) {
    comb.push_back({4 * i, 0});
    comb.push_back({4 * i + 2, i % 2 == 0 ? 9000 - 5 * i : 100 + i});
  }
  comb.push_back({6000, -10});
  comb.push_back({0, -10});
  if (twice_area(comb) < 0) std::reverse(comb.begin(), comb.end());
  expect_covered(comb, random, "comb");
  Outline spiral;
  for (int arm = 0; arm < 2; ++arm) {
    Outline side;
    for (int i = 0; i < 500; ++i) {
      const double radius = 20.0 + i * 4.0 + arm * 30.0;
      const double angle = 2.0 * std::numbers::pi * i / 25.0;
      side.push_back(
          {std::llround(radius * std::cos(angle)), std::llround(radius * std::sin(angle))});
    }
    if (arm == 1) std::reverse(side.begin(), side.end());
    spiral.insert(spiral.end(), side.begin(), side.end());
  }
  if (twice_area(spiral) < 0) std::reverse(spiral.begin(), spiral.end());
  expect_covered(spiral, random, "spiral");
}

// An outline that takes more comparisons than allowed is not folded silently.
TEST(Polygon, SaysThatItGaveUp) {
  // A comb of long teeth that lean over: the box of each is in the way of all others.
  for (const int num_corners : {200, 20000}) {
    std::vector<std::array<double, 3>> comb{{0, -10, 0}};
    for (int i = 0; i < num_corners; ++i) {
      const double tooth = i % 2 == 0 ? 0.0 : num_corners;
      comb.push_back({i + tooth, tooth, 0.0});
    }
    comb.push_back({1.0 * num_corners, -10, 0});
    bool gave_up = false;
    split_polygon(comb, &gave_up);
    EXPECT_EQ(gave_up, num_corners > 1000) << num_corners;
  }
}

// Outlines are turned in space and have seven digits, as in files.
TEST(Polygon, CoversOutlinesThatAreNotQuiteFlat) {
  Random random(8);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const Outline outline = untangled(random, 4 + below(random, 9), 50);
    std::array<std::array<double, 3>, 2> axes{};
    for (auto& axis : axes) {
      for (double& x : axis) x = normal(random);
    }
    Corners corners;
    for (const Point& p : outline) {
      std::array<double, 3> corner{};
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = 100.0 + static_cast<double>(p[0]) * axes[0][c] +
                         static_cast<double>(p[1]) * axes[1][c];
        corner[c] = static_cast<double>(static_cast<float>(x));
      }
      corners.push_back(corner);
    }
    double covered = 0.0;
    for (const PolygonTriangle& t : triangles_of(corners)) {
      covered += std::abs(
          static_cast<double>(twice_area(outline[t[0]], outline[t[1]], outline[t[2]])));
    }
    EXPECT_NEAR(covered, static_cast<double>(twice_area(outline)), 1e-9) << i;
  }
}

TEST(Polygon, EndsWithWhateverCrossesItself) {
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    Corners corners(4 + below(random, i % 50 == 0 ? 1000 : 12));
    for (auto& corner : corners) {
      for (double& x : corner) x = static_cast<double>(below(random, i % 2 == 0 ? 3 : 1000));
    }
    const auto triangles = split_polygon(corners);
    EXPECT_TRUE(triangles.empty() || triangles.size() + 2 == corners.size());
    for (const PolygonTriangle& t : triangles) {
      for (const std::uint32_t corner : t) EXPECT_LT(corner, corners.size());
    }
  }
  EXPECT_TRUE(split_polygon(Corners(5, {1, 2, 3})).empty());
}

// The same hexagon in the formats that have polygons.
TEST(Polygon, IsSplitInEveryFormat) {
  const std::vector<Triangle> expected =
      parse_obj("v 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nf 1 2 3 4 5 6\n",
                "l.obj")
          ->triangles;
  ASSERT_EQ(expected.size(), 4U);
  const Outline l{{2, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 0}, {2, 0}};
  EXPECT_EQ(find_fault(l, {expected.begin(), expected.end()}), "");
  const std::string rows = "2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 0\n2 0 0\n6 0 1 2 3 4 5\n";
  EXPECT_EQ(parse_off("OFF\n6 1 0\n" + rows, "l.off")->triangles, expected);
  EXPECT_EQ(parse_ply("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\n"
                      "property float y\nproperty float z\nelement face 1\n"
                      "property list uchar int vertex_indices\nend_header\n" +
                          rows,
                      "l.ply")
                ->triangles,
            expected);
}

// Expects texture coordinates equal to positions: they stay at their corners.
void expect_uv_at_positions(const InputResult<SingleMesh>& mesh) {
  ASSERT_TRUE(mesh) << mesh.error().message;
  ASSERT_EQ(mesh->attributes.sets.size(), 1U);
  const SourceAttribute& uv = mesh->attributes.sets[0];
  ASSERT_EQ(uv.value_of_corner.size(), 3 * mesh->triangles.size());
  for (std::size_t c = 0; c < uv.value_of_corner.size(); ++c) {
    const std::size_t v = mesh->triangles[c / 3][c % 3];
    EXPECT_EQ(uv.values[2 * uv.value_of_corner[c]], mesh->xyz[3 * v]) << c;
    EXPECT_EQ(uv.values[2 * uv.value_of_corner[c] + 1], 1.0F - mesh->xyz[3 * v + 1]) << c;
  }
}

TEST(Polygon, CarriesTheValuesOfItsCorners) {
  std::string text;
  for (const char* p : {"2 1", "1 1", "1 2", "0 2", "0 0", "2 0"}) {
    text += "v " + std::string(p) + " 0\n";
  }
  for (const char* p : {"0 0", "2 0", "2 1", "1 1", "1 2", "0 2"}) {
    text += "vt " + std::string(p) + "\n";
  }
  expect_uv_at_positions(
      parse_obj(text + "f 1/3 2/4 3/5\nf 1/3 2/4 3/5 4/6 5/1 6/2\n", "l.obj"));
}

TEST(Polygon, CarriesTheNormalsOfItsCorners) {
  const std::vector<std::vector<float>> normals{{1, 0, 0},  {0, 1, 0},  {0, 0, 1},
                                                {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  const auto mesh = parse_obj(
      "v 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nvn 1 0 0\nvn 0 1 0\nvn 0 0 1\n"
      "vn -1 0 0\nvn 0 -1 0\nvn 0 0 -1\nf 1//1 2//2 3//3 4//4 5//5 6//6\n",
      "l.obj");
  ASSERT_TRUE(mesh) << mesh.error().message;
  ASSERT_EQ(mesh->attributes.sets.size(), 1U);
  const SourceAttribute& set = mesh->attributes.sets[0];
  for (std::size_t c = 0; c < set.value_of_corner.size(); ++c) {
    const auto first = set.values.begin() + 3 * static_cast<long>(set.value_of_corner[c]);
    EXPECT_EQ(std::vector<float>(first, first + 3), normals[mesh->triangles[c / 3][c % 3]])
        << c;
  }
}

TEST(Polygon, CarriesTheValuesOfItsCornersInPlyFiles) {
  expect_uv_at_positions(
      parse_ply("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
                "property list uchar float texcoord\nend_header\n"
                "2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 0\n2 0 0\n"
                "3 0 1 2 6 2 1 1 1 1 2\n6 0 1 2 3 4 5 12 2 1 1 1 1 2 0 2 0 0 2 0\n",
                "l.ply"));
}

}  // namespace
}  // namespace rlpc
