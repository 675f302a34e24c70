#include "decoder/surface/split_vertices.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

using Indices = std::vector<std::uint32_t>;

// A square of two triangles, and a vertex without any.
const std::vector<Triangle> kTwoTriangles{{0, 1, 2}, {0, 2, 3}};
constexpr std::uint32_t kVertices = 5;

AttributeSet set_of(AttributeDomain domain, Indices values, Indices value_of_corner) {
  AttributeSet set;
  set.header.domain = domain;
  set.values = std::move(values);
  set.value_of_corner = std::move(value_of_corner);
  return set;
}

SplitVertices split(const std::vector<const AttributeSet*>& sets) {
  SplitVertices vertices = split_vertices(kTwoTriangles, kVertices, sets);
  EXPECT_EQ(vertices.triangles.size(), kTwoTriangles.size());
  for (std::size_t c = 0; c < 6; ++c) {
    const std::uint32_t v = vertices.triangles[c / 3][c % 3];
    EXPECT_EQ(vertices.stream_vertex[v], kTwoTriangles[c / 3][c % 3]);
  }
  return vertices;
}

TEST(SplitVertices, WithoutSeamsVerticesAreThoseOfTheStream) {
  const AttributeSet set = set_of(AttributeDomain::kVertex, {7, 7, 8, 9, 6}, {});
  for (const auto& sets : {std::vector<const AttributeSet*>{}, {&set}}) {
    const SplitVertices vertices = split(sets);
    EXPECT_EQ(vertices.stream_vertex, (Indices{0, 1, 2, 3, 4}));
    EXPECT_EQ(vertices.triangles, kTwoTriangles);
  }
  // Values that are equal count as one.
  EXPECT_EQ(split({&set}).value_of_vertex[0], (Indices{0, 0, 2, 3, 4}));
}

TEST(SplitVertices, EachCombinationOfValuesIsAVertex) {
  // Different at vertex 2, equal at vertex 0.
  const AttributeSet a =
      set_of(AttributeDomain::kCorner, {1, 2, 3, 1, 4, 5}, {0, 1, 2, 3, 4, 5});
  // Different at vertex 0.
  const AttributeSet b = set_of(AttributeDomain::kCorner, {1, 2, 3}, {0, 1, 2, 1, 2, 0});
  const SplitVertices one = split({&a});
  EXPECT_EQ(one.stream_vertex, (Indices{0, 1, 2, 2, 3, 4}));
  EXPECT_EQ(one.value_of_vertex[0], (Indices{0, 1, 2, 4, 5, 0}));
  EXPECT_EQ(one.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 3, 4}}));
  const SplitVertices both = split({&a, &b});
  EXPECT_EQ(both.stream_vertex, (Indices{0, 0, 1, 2, 2, 3, 4}));
  EXPECT_EQ(both.value_of_vertex[0], (Indices{0, 0, 1, 2, 4, 5, 0}));
  EXPECT_EQ(both.value_of_vertex[1], (Indices{0, 1, 1, 2, 2, 0, 0}));
  EXPECT_EQ(both.triangles, (std::vector<Triangle>{{0, 2, 3}, {1, 4, 5}}));
}

TEST(SplitVertices, NormalsThatMoveCountByTheirIndex) {
  AttributeSet set = set_of(AttributeDomain::kCorner, {}, {0, 1, 2, 3, 2, 4});
  set.header.kind = ValueKind::kSmoothing;
  set.header.num_components = 0;
  EXPECT_EQ(split({&set}).stream_vertex, (Indices{0, 0, 1, 2, 3, 4}));
  set.header.kind = ValueKind::kUnitVectors;
  set.header.num_components = 2;
  set.header.prediction = AttributePrediction::kPositions;
  set.values = Indices(10, 5);
  EXPECT_EQ(split({&set}).value_of_vertex[0], (Indices{0, 3, 1, 2, 4, 0}));
  set.header.prediction = AttributePrediction::kMean;
  EXPECT_EQ(split({&set}).value_of_vertex[0], (Indices{0, 0, 0, 0, 0}));
}

TEST(SplitVertices, AVertexOfManyTrianglesTakesNoTimeSquared) {
  constexpr std::uint32_t kFan = 200000;
  std::vector<Triangle> fan;
  AttributeSet set = set_of(AttributeDomain::kCorner, {}, {});
  for (std::uint32_t t = 0; t < kFan; ++t) {
    fan.push_back({0, t + 1, t + 2});
    for (std::uint32_t k = 0; k < 3; ++k) {
      set.value_of_corner.push_back(3 * t + k);
      set.values.push_back(3 * t + k);
    }
  }
  const AttributeSet* const sets[] = {&set};
  EXPECT_EQ(split_vertices(fan, kFan + 2, sets).num_vertices(), 3 * kFan);
}

}  // namespace
}  // namespace rlpc
