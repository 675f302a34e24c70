#include "encoder/codec/write/half_edges.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

using Triangles = std::vector<Triangle>;

std::uint32_t num_boundary_edges(const HalfEdges& mesh) {
  std::uint32_t n = 0;
  for (const std::uint32_t opposite : mesh.opposite) {
    if (opposite == HalfEdges::kNone) ++n;
  }
  return n;
}

void expect_glued_pairs_run_against_each_other(const HalfEdges& mesh,
                                               const Triangles& triangles) {
  for (std::uint32_t h = 0; h < mesh.opposite.size(); ++h) {
    const std::uint32_t o = mesh.opposite[h];
    if (o == HalfEdges::kNone) continue;
    EXPECT_EQ(mesh.opposite[o], h);
    const std::uint32_t h_end = next_corner(h);
    const std::uint32_t o_end = next_corner(o);
    EXPECT_EQ(triangles[h / 3][h % 3], triangles[o_end / 3][o_end % 3]);
    EXPECT_EQ(triangles[o / 3][o % 3], triangles[h_end / 3][h_end % 3]);
  }
}

TEST(HalfEdges, ClosedSurfaceHasNoBoundaryAndOneInstancePerVertex) {
  const Triangles tetrahedron{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  const HalfEdges mesh = build_half_edges(4, tetrahedron);
  expect_glued_pairs_run_against_each_other(mesh, tetrahedron);
  EXPECT_EQ(num_boundary_edges(mesh), 0U);
  EXPECT_EQ(mesh.num_instances, 4U);
}

TEST(HalfEdges, FansThatMeetInAVertexAreSeparateInstances) {
  const Triangles bow_tie{{0, 1, 2}, {0, 3, 4}};
  const HalfEdges mesh = build_half_edges(5, bow_tie);
  EXPECT_EQ(num_boundary_edges(mesh), 6U);
  EXPECT_EQ(mesh.num_instances, 6U);
  EXPECT_NE(mesh.instance[0], mesh.instance[3]);
}

TEST(HalfEdges, ThirdTriangleOnAnEdgeIsNotGlued) {
  const Triangles book{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  const HalfEdges mesh = build_half_edges(5, book);
  expect_glued_pairs_run_against_each_other(mesh, book);
  EXPECT_EQ(mesh.opposite[0], 3U);
  EXPECT_EQ(mesh.opposite[6], HalfEdges::kNone);
  EXPECT_EQ(mesh.num_instances, 7U);
}

TEST(HalfEdges, EdgesOfInconsistentWindingStayOpen) {
  const HalfEdges mesh = build_half_edges(4, Triangles{{0, 1, 2}, {0, 1, 3}});
  EXPECT_EQ(num_boundary_edges(mesh), 6U);
}

TEST(HalfEdges, FlippedDuplicatesMakeAPillow) {
  const Triangles pillow{{0, 1, 2}, {0, 2, 1}};
  const HalfEdges mesh = build_half_edges(3, pillow);
  expect_glued_pairs_run_against_each_other(mesh, pillow);
  EXPECT_EQ(num_boundary_edges(mesh), 0U);
  EXPECT_EQ(mesh.num_instances, 3U);
}

}  // namespace
}  // namespace rlpc
