#include "common/codec/attributes/recon/normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace rlpc {
namespace {

TEST(CornerGeometry, AnglesComeNearThoseOfFloats) {
  const std::vector<Triangle> triangles{{0, 1, 2}};
  const auto angle_of = [&](const std::vector<std::int32_t>& positions, std::uint32_t c) {
    const CornerGeometry geometry(triangles, positions);
    return static_cast<double>(geometry.angle_at(c)) / 8192;
  };
  EXPECT_NEAR(angle_of({0, 0, 0, 1000, 0, 0, 0, 1000, 0}, 0), M_PI / 2, 2e-4);
  EXPECT_NEAR(angle_of({0, 0, 0, 1000, 0, 0, 0, 1000, 0}, 1), M_PI / 4, 2e-4);
  EXPECT_NEAR(angle_of({0, 0, 0, 1000, 0, 0, -1000, 10, 0}, 0), M_PI - 0.01, 3e-4);
  EXPECT_NEAR(angle_of({0, 0, 0, 1000, 0, 0, 5000, 50, 0}, 0), 0.01, 3e-4);
  // Far apart, so that differences are shifted.
  EXPECT_NEAR(angle_of({-4000000, 0, 0, 4000000, 0, 0, -4000000, 8000000, 0}, 1), M_PI / 4,
              2e-4);
  // An edge without length.
  EXPECT_EQ(angle_of({5, 5, 5, 5, 5, 5, 9, 5, 5}, 0), 0);
  EXPECT_EQ(angle_of({5, 5, 5, 9, 5, 5, 5, 5, 5}, 0), 0);
}

TEST(Octahedron, FoldsTheLowerHalf) {
  EXPECT_EQ(octahedral_of({0, 0, 9}, 10), (OctahedronPoint{511, 511}));
  EXPECT_EQ(octahedral_of({0, 0, 0}, 10), (OctahedronPoint{511, 511}));
  EXPECT_EQ(octahedral_of({7, 0, 0}, 10), (OctahedronPoint{1022, 511}));
  EXPECT_EQ(octahedral_of({0, 0, -9}, 10), (OctahedronPoint{1022, 1022}));
  EXPECT_EQ(octahedral_of({-1, -1, -2}, 10), octahedral_of({-1000, -1000, -2000}, 10));
  EXPECT_EQ(octahedral_of({1, 1, 1}, 2), (OctahedronPoint{1, 1}));
}

// A square in the plane z = 0, and a wall on its edge from vertex 1 to vertex 2.
class SquareAndWall : public ::testing::Test {
 protected:
  const std::vector<Triangle> triangles_{{0, 1, 2}, {0, 2, 3}, {2, 1, 4}};
  const std::vector<std::int32_t> positions_{0, 0, 0,   100, 0,   0,  100, 100,
                                             0, 0, 100, 0,   100, 50, 80};
  const CornerGeometry geometry_{triangles_, positions_};
  const std::vector<std::uint32_t> mates_ = find_edge_mates(5, triangles_);
};

TEST_F(SquareAndWall, EdgesHaveMates) {
  EXPECT_EQ(mates_[2], 3U);  // the diagonal
  EXPECT_EQ(mates_[3], 2U);
  EXPECT_EQ(mates_[1], 6U);
  EXPECT_EQ(mates_[0], kNoCorner);
}

TEST_F(SquareAndWall, LikelyDiagonalJoinsTheSquare) {
  const std::vector<bool> none(mates_.size(), false);
  Faces faces(geometry_, Diagonals::kLikely, mates_, none, none, true);
  EXPECT_EQ(faces.face_of_triangle(), (std::vector<std::uint32_t>{0, 0, 2}));
  EXPECT_EQ(faces.view().normals[0], (Vec3l{0, 0, 20000}));
  // The flag excludes the likely diagonal.
  std::vector<bool> flags = none;
  flags[2] = flags[3] = true;
  Faces apart(geometry_, Diagonals::kLikely, mates_, none, flags, true);
  EXPECT_EQ(apart.face_of_triangle(), (std::vector<std::uint32_t>{0, 1, 2}));
  Faces flagged(geometry_, Diagonals::kFlagged, mates_, none, flags, true);
  EXPECT_EQ(flagged.face_of_triangle(), (std::vector<std::uint32_t>{0, 0, 2}));
}

TEST_F(SquareAndWall, WeightsOfFaces) {
  const std::vector<bool> none(mates_.size(), false);
  const Faces faces(geometry_, Diagonals::kLikely, mates_, none, none, true);
  const std::vector<std::uint32_t> around{1, 7};  // vertex 1, in the square and in the wall
  const auto slope = [&](SmoothingWeight weight) {
    const Vec3l n = sector_normal(geometry_, faces.view(), weight, around);
    EXPECT_EQ(n[1], 0);
    return static_cast<double>(n[0]) / static_cast<double>(n[2]);
  };
  EXPECT_NEAR(slope(SmoothingWeight::kEqual), -1.0, 1e-3);
  EXPECT_NEAR(slope(SmoothingWeight::kArea), -8000.0 / 20000.0, 1e-3);
  EXPECT_NEAR(slope(SmoothingWeight::kAngle), -std::atan2(80, 50) / (M_PI / 2), 1e-3);
}

}  // namespace
}  // namespace rlpc
