#include "decoder/web/wasm/frame_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

using Edge = std::array<std::uint32_t, 2>;

TEST(VertexNormals, OfAHorizontalSquarePointUp) {
  const std::vector<float> coordinates{0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1};
  const std::vector<Triangle> triangles{{0, 2, 1}, {0, 3, 2}};
  std::vector<Vec3f> normals;
  vertex_normals(coordinates, triangles, normals);
  EXPECT_EQ(normals, std::vector<Vec3f>(4, Vec3f{0, 1, 0}));
}

TEST(VertexNormals, AreWeightedByArea) {
  // A triangle in the xy plane, and one of three times the area in the xz plane.
  const std::vector<float> coordinates{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -3};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 1, 3}};
  std::vector<Vec3f> normals;
  vertex_normals(coordinates, triangles, normals);
  EXPECT_NEAR(normals[0][1], 3 / std::sqrt(10), 1e-6);
  EXPECT_NEAR(normals[0][2], 1 / std::sqrt(10), 1e-6);
  EXPECT_EQ(normals[2], (Vec3f{0, 0, 1}));
  EXPECT_EQ(normals[3], (Vec3f{0, 1, 0}));
}

TEST(VertexNormals, AreUnitVectorsWithoutAreaAndForTinyTriangles) {
  const float tiny = 1e-12F;
  const std::vector<float> coordinates{0, 0, 0, 0, tiny, 0, 0, 0, tiny, 1, 1, 1};
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 3, 0}};
  std::vector<Vec3f> normals;
  vertex_normals(coordinates, triangles, normals);
  EXPECT_EQ(normals[0], (Vec3f{1, 0, 0}));
  EXPECT_EQ(normals[3], (Vec3f{0, 0, 1}));
}

TEST(UnitNormals, AreTheZAxisWithoutADirection) {
  std::vector<Vec3f> normals;
  unit_normals(std::vector<double>{0, -3e11, 0, 0, 0, 0, 0, 3e-11, 4e-11}, normals);
  ASSERT_EQ(normals.size(), 3U);
  EXPECT_EQ(normals[0], (Vec3f{0, -1, 0}));
  EXPECT_EQ(normals[1], (Vec3f{0, 0, 1}));
  EXPECT_NEAR(normals[2][1], 0.6, 1e-6);
}

TEST(EdgesOf, ListsEachEdgeOnce) {
  const std::vector<Triangle> tetrahedron{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  EXPECT_EQ(drawn_edges(tetrahedron),
            (std::vector<Edge>{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}));
  EXPECT_TRUE(drawn_edges({}).empty());
}

TEST(ExtentOf, HoldsAllVertices) {
  const FrameExtent extent = extent_of(std::vector<std::int32_t>{5, -10, 0, -2, 0, 20});
  EXPECT_EQ(extent.min, (std::array<std::int32_t, 3>{-2, -10, 0}));
  EXPECT_EQ(extent.max, (std::array<std::int32_t, 3>{5, 0, 20}));
}

TEST(CentredCoordinates, AreInvariantUnderTranslation) {
  const std::vector<std::int32_t> positions{0, 5, -7, 1, 9, 1, 6, 5, -7};
  std::vector<float> here(positions.size());
  centred_coordinates(positions, extent_of(positions), 2, here);
  EXPECT_EQ(here, (std::vector<float>{-1.5, -1, -2, -1, 1, 2, 1.5, -1, -2}));
  std::vector<std::int32_t> moved = positions;
  for (std::int32_t& x : moved) x += 1 << 30;  // floats there are 128 apart
  std::vector<float> there(positions.size());
  centred_coordinates(moved, extent_of(moved), 2, there);
  EXPECT_EQ(there, here);
}

TEST(CentredCoordinates, ReachTheFacesOfTheCube) {
  for (const int bits : {2, 20, 24}) {
    const std::int32_t half = 1 << (bits - 1);
    const std::vector<std::int32_t> positions{-half, -half, -half, half, half, half};
    std::vector<float> coordinates(positions.size());
    centred_coordinates(positions, extent_of(positions), bits, coordinates);
    EXPECT_EQ(coordinates, (std::vector<float>{-1, -1, -1, 1, 1, 1}));
  }
}

}  // namespace
}  // namespace rlpc
