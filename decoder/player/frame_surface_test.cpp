#include "decoder/player/frame_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/io/float_position.h"
#include "decoder/player/stream_player.h"

namespace rlpc {
namespace {

using Edge = std::array<std::uint32_t, 2>;

constexpr std::int16_t kOne = 32767;

TEST(VertexNormals, OfAHorizontalSquarePointUp) {
  const std::vector<float> coordinates{0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1};
  const std::vector<Triangle> triangles{{0, 2, 1}, {0, 3, 2}};
  std::vector<PackedNormal> normals;
  vertex_normals(coordinates, triangles, normals);
  EXPECT_EQ(normals, std::vector<PackedNormal>(4, PackedNormal{0, kOne, 0, 0}));
}

TEST(VertexNormals, AreWeightedByArea) {
  // A triangle in the xy plane, and one of three times the area in the xz plane.
  const std::vector<float> coordinates{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -3};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 1, 3}};
  std::vector<PackedNormal> normals;
  vertex_normals(coordinates, triangles, normals);
  EXPECT_NEAR(normals[0][1], kOne * 3 / std::sqrt(10), 1);
  EXPECT_NEAR(normals[0][2], kOne / std::sqrt(10), 1);
  EXPECT_EQ(normals[2], (PackedNormal{0, 0, kOne, 0}));
  EXPECT_EQ(normals[3], (PackedNormal{0, kOne, 0, 0}));
}

TEST(VertexNormals, AreUnitVectorsWithoutAreaAndForTinyTriangles) {
  const float tiny = 1e-12F;
  const std::vector<float> coordinates{0, 0, 0, 0, tiny, 0, 0, 0, tiny, 1, 1, 1};
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 3, 0}};
  std::vector<PackedNormal> normals;
  vertex_normals(coordinates, triangles, normals);
  EXPECT_EQ(normals[0], (PackedNormal{kOne, 0, 0, 0}));
  EXPECT_EQ(normals[3], (PackedNormal{0, 0, kOne, 0}));
}

TEST(EdgesOf, ListsEachEdgeOnce) {
  const std::vector<Triangle> tetrahedron{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  EXPECT_EQ(drawn_edges(tetrahedron),
            (std::vector<Edge>{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}));
  EXPECT_TRUE(drawn_edges({}).empty());
}

TEST(BoxOf, HoldsAllVertices) {
  const std::vector<float> coordinates{0.5F, -1, 0, -0.25F, 0, 2};
  const Box box = box_of(coordinates);
  EXPECT_EQ(box.least, (std::array<float, 3>{-0.25F, -1, 0}));
  EXPECT_EQ(box.most, (std::array<float, 3>{0.5F, 0, 2}));
}

TEST(VertexDistances, AreEuclidean) {
  const std::vector<float> a{0, 0, 0, 1, 1, 1};
  const std::vector<float> b{3, 0, 4, 1, 1, 1};
  std::vector<float> distances;
  const Deviation deviation = vertex_distances(a, b, {}, distances);
  EXPECT_EQ(distances, (std::vector<float>{5, 0}));
  EXPECT_EQ(deviation.largest, 5);
  EXPECT_FLOAT_EQ(deviation.root_mean_square, std::sqrt(12.5F));
  vertex_distances(a, b, {3, 0, 0}, distances);
  EXPECT_EQ(distances, (std::vector<float>{4, 3}));
}

SequenceHeader header_with(int position_bits, const Grid& grid) {
  SequenceHeader header;
  header.position_bits = position_bits;
  header.grid = grid;
  return header;
}

TEST(Placement, MapsTheExtremesToTheCube) {
  for (const int bits : {2, 20, 24}) {
    const Placement placement = placement_of(header_with(bits, {-150, {1, 2, 3}}));
    EXPECT_EQ(-std::ldexp(1.0, bits - 1) * placement.scale, -1.0);
    EXPECT_EQ(placement.offset, (std::array<double, 3>{0, 0, 0}));
  }
}

TEST(Placement, OfAReferenceKeepsItsCoordinates) {
  const SequenceHeader header = header_with(16, {-9, {1000, -5, 0}});
  const SequenceHeader fine = header_with(24, {-15, {63000, 7, -100}});
  const Placement own = placement_of(header);
  const Placement other = placement_in(fine, header);
  // Two representations of the same position: 1000 + 40 steps, and 64 times as many finer
  // steps.
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int32_t position = 40;
    const std::int32_t same = 64 * (position + header.grid.origin[c]) - fine.grid.origin[c];
    EXPECT_EQ(float_position(header.grid, c, position), float_position(fine.grid, c, same));
    EXPECT_DOUBLE_EQ(position * own.scale + own.offset[c],
                     same * other.scale + other.offset[c]);
  }
}

TEST(CentredCoordinates, AreInvariantUnderTranslation) {
  const std::vector<std::int32_t> positions{0, 5, -7, 1, 9, 1, 6, 5, -7};
  std::vector<float> here(positions.size());
  EXPECT_EQ(centred_coordinates(positions, {0.5, {}}, here), (Vec3d{1.5, 3.5, -1.5}));
  EXPECT_EQ(here, (std::vector<float>{-1.5, -1, -2, -1, 1, 2, 1.5, -1, -2}));
  std::vector<std::int32_t> moved = positions;
  for (std::int32_t& x : moved) x += 1 << 23;
  std::vector<float> there(positions.size());
  // Beyond 24 bits, floats would not resolve the steps of the grid.
  centred_coordinates(moved, {0.5, {1e9, 0, 0}}, there);
  EXPECT_EQ(there, here);
}

}  // namespace
}  // namespace rlpc
