#include "decoder/codec/parse/sequence/parse_connectivity.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/bits/range_encoder.h"
#include "common/codec/mesh/connectivity_models.h"
#include "common/codec/mesh/cut_border.h"
#include "common/testing/element_lines.h"
#include "decoder/testing/expected_errors.h"

namespace rlpc {
namespace {

using Triangles = std::vector<Triangle>;

// num_degenerate_triangles 0, urgent_degree 3, vertex_reuse_flag 0; the elements of the section
// are listed in the first test.
const std::vector<std::uint8_t> kTetrahedron{0x98, 0xCB};

Result<Triangles> triangles_in(const std::vector<std::uint8_t>& payload,
                               std::uint32_t num_vertices, std::uint32_t num_triangles,
                               Trace* trace = nullptr) {
  BitReader r(payload, 0, trace);
  return parse_connectivity(r, num_vertices, num_triangles);
}

// Writes a payload bin by bin; the border only serves to find the contexts of the first gate.
class Recipe {
 public:
  explicit Recipe(std::uint32_t num_degenerate, bool vertex_reuse = false) {
    header_.ue(num_degenerate);
    header_.u(4, 4);
    header_.u(1, vertex_reuse ? 1 : 0);
    header_.byte_alignment();
    border_.start_component(0, 1, 2);
    border_.select_gate();
  }
  ConnectivityModels models;
  RangeEncoder section;
  GateContexts first_gate() const { return gate_contexts(border_); }
  std::vector<std::uint8_t> payload() {
    header_.append(section.finish());
    return header_.take();
  }

 private:
  BitWriter header_;
  CutBorder border_{4};
};

TEST(ParseConnectivity, DecodesATetrahedron) {
  ElementLines lines;
  const auto decoded = triangles_in(kTetrahedron, 4, 4, &lines);
  ASSERT_TRUE(decoded);
  EXPECT_EQ(*decoded, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 3}}));
  EXPECT_EQ(lines.text,
            "num_degenerate_triangles 0\nurgent_degree 3\nvertex_reuse_flag 0\n"
            "boundary_flag 0\nclose_flag 0\nnew_vertex_flag 1\n"
            "boundary_flag 0\nglue_previous_flag 1\n"
            "boundary_flag 0\nclose_flag 1\n");
}

TEST(ParseConnectivity, EveryProperPrefixFails) {
  for (std::size_t n = 0; n < kTetrahedron.size(); ++n) {
    const std::vector<std::uint8_t> prefix(kTetrahedron.begin(),
                                           kTetrahedron.begin() + static_cast<long>(n));
    EXPECT_FALSE(triangles_in(prefix, 4, 4)) << n;
  }
}

TEST(ParseConnectivity, SurplusBytesFail) {
  std::vector<std::uint8_t> longer = kTetrahedron;
  longer.push_back(0);
  expect_invalid(triangles_in(longer, 4, 4), "R-RNG-01", "connectivity_section");
}

TEST(ParseConnectivity, SectionMustNotStartWithOnes) {
  expect_invalid(triangles_in({0xA0, 0xFF, 0xFF, 0xFF, 0xFF}, 4, 4), "R-RNG-02",
                 "connectivity_section");
}

TEST(ParseConnectivity, DegenerateTrianglesAreAtMostAllTriangles) {
  EXPECT_TRUE(triangles_in(Recipe(0).payload(), 3, 1));
  expect_invalid(triangles_in(Recipe(2).payload(), 3, 1), "R-CON-01",
                 "num_degenerate_triangles");
}

TEST(ParseConnectivity, ComponentNeedsThreeVerticesMore) {
  expect_invalid(triangles_in(Recipe(0).payload(), 2, 1), "R-CON-02", "component_start");
}

TEST(ParseConnectivity, ReusedVertexHasOccurredBefore) {
  for (const std::uint32_t reused_vertex : {2U, 3U}) {
    Recipe recipe(0, true);
    recipe.section.bin(recipe.models.vertex_reused_flag, false);
    recipe.section.bin(recipe.models.vertex_reused_flag, false);
    const GateContexts ctx = recipe.first_gate();
    recipe.section.bin(recipe.models.boundary_flag[ctx.boundary_flag], false);
    recipe.section.bin(recipe.models.close_flag[ctx.close_flag], false);
    recipe.section.bin(recipe.models.new_vertex_flag[ctx.new_vertex_flag], true);
    recipe.section.bin(recipe.models.vertex_reused_flag, true);
    recipe.section.bypass(2, reused_vertex);
    const auto decoded = triangles_in(recipe.payload(), 4, 2);
    if (reused_vertex < 3) {
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->back(), (Triangle{0, 2, 2}));
    } else {
      expect_invalid(decoded, "R-CON-03", "reused_vertex");
    }
  }
}

// The nodes of the first triangle are 0, 1 and 2; node 0 is the gate and node 1 the next node.
TEST(ParseConnectivity, JoinTargetIsAnotherLiveNode) {
  for (const std::uint32_t node : {0U, 1U, 2U, 3U}) {
    Recipe recipe(0);
    const GateContexts ctx = recipe.first_gate();
    recipe.section.bin(recipe.models.boundary_flag[ctx.boundary_flag], false);
    recipe.section.bin(recipe.models.close_flag[ctx.close_flag], false);
    recipe.section.bin(recipe.models.glue_previous_flag[ctx.glue_previous_flag], false);
    recipe.section.bin(recipe.models.glue_next_flag[ctx.glue_next_flag], false);
    recipe.section.bin(recipe.models.far_join_flag, true);
    recipe.section.bypass(2, node);
    const auto decoded = triangles_in(recipe.payload(), 3, 2);
    if (node == 2) {
      ASSERT_TRUE(decoded);
      EXPECT_EQ(decoded->back(), (Triangle{0, 2, 1}));
    } else {
      expect_invalid(decoded, "R-CON-04", "join_target");
    }
  }
}

TEST(ParseConnectivity, DegenerateVertexExists) {
  for (const std::uint32_t degenerate_vertex : {2U, 3U}) {
    Recipe recipe(1);
    for (int i = 0; i < 3; ++i) recipe.section.bypass(2, degenerate_vertex);
    const auto decoded = triangles_in(recipe.payload(), 3, 1);
    if (degenerate_vertex < 3) {
      ASSERT_TRUE(decoded);
      EXPECT_EQ(*decoded, (Triangles{{2, 2, 2}}));
    } else {
      expect_invalid(decoded, "R-CON-05", "degenerate_vertex");
    }
  }
}

// Declaring millions of triangles fails with the last byte: the bins cannot all be free.
TEST(ParseConnectivity, ShortPayloadWithManyClaimedTrianglesFails) {
  for (const int fill : {0x00, 0x55, 0xFE}) {
    std::vector<std::uint8_t> payload(20, static_cast<std::uint8_t>(fill));
    payload[0] = 0xA0;
    EXPECT_FALSE(triangles_in(payload, 4000000, 8000000)) << fill;
  }
}

}  // namespace
}  // namespace rlpc
