#include "encoder/meshes/axes.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "encoder/testing/turned.h"

namespace rlpc {
namespace {

TEST(Axes, AreSignedAxesOfTheInput) {
  EXPECT_EQ(turned("x,y,z", {1, 2, 3}), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(turned("x,z,-y", {1, 2, 3, 4, 5, 6}), (std::vector<float>{1, 3, -2, 4, 6, -5}));
  EXPECT_EQ(turned("-z,x,-y", {1, 2, 3}), (std::vector<float>{-3, 1, -2}));
}

TEST(Axes, AreWrittenAsTheyAreRead) {
  for (const std::string text : {"x,y,z", "x,z,-y", "-x,-y,-z", "-z,x,y"}) {
    EXPECT_EQ(axes_text(*parse_axes(text)), text);
  }
}

TEST(Axes, AreEachUsedOnce) {
  for (const std::string text : {"", "x", "x,y", "x,y,", "x,y,y", "x,y,w", "x,y,z,", "x,y,z,x",
                                 "xyz", "x, y, z", "--x,y,z", "X,Y,Z"}) {
    const auto axes = parse_axes(text);
    ASSERT_FALSE(axes) << text;
    EXPECT_NE(axes.error().message.find("such as x,z,-y"), std::string::npos);
  }
}

TEST(Axes, AreMirroredByOneExchangeOrSign) {
  for (const std::string text : {"x,y,z", "x,z,-y", "x,-z,y", "-x,-y,z", "y,z,x"}) {
    EXPECT_FALSE(is_mirror(*parse_axes(text))) << text;
  }
  for (const std::string text : {"x,z,y", "-x,y,z", "-x,-y,-z", "-y,z,x"}) {
    EXPECT_TRUE(is_mirror(*parse_axes(text))) << text;
  }
}

class OneTriangle final : public FrameSource {
 public:
  explicit OneTriangle(const std::optional<Axes>& axes_of_mesh,
                       const SourceAttributes& attributes = {})
      : FrameSource(shape(attributes)) {
    set_axes_of_mesh(axes_of_mesh);
  }
  std::optional<InputError> read_frame(std::uint32_t /*frame*/, std::span<float> xyz) override {
    for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] = static_cast<float>(i);
    return std::nullopt;
  }

 private:
  static Shape shape(const SourceAttributes& attributes) {
    Shape s;
    s.attributes = attributes;
    s.num_vertices = 3;
    s.num_frames = 1;
    s.triangles = {{0, 1, 2}};
    return s;
  }
};

std::unique_ptr<FrameSource> turned_triangle(const std::string& axes,
                                             const std::string& mesh_axes = "") {
  const auto mesh = mesh_axes.empty() ? std::nullopt : std::optional(*parse_axes(mesh_axes));
  return turn_source(std::make_unique<OneTriangle>(mesh), *parse_axes(axes));
}

TEST(TurnedSource, TurnsPositions) {
  std::vector<float> xyz(9);
  ASSERT_FALSE(turned_triangle("x,z,-y")->read_frame(0, xyz));
  EXPECT_EQ(xyz, (std::vector<float>{0, 2, -1, 3, 5, -4, 6, 8, -7}));
}

TEST(TurnedSource, KeepsTheSideThatTrianglesFace) {
  const Triangle as_it_is{0, 1, 2};
  const Triangle turned_over{0, 2, 1};
  EXPECT_EQ(turned_triangle("x,z,-y")->triangles()[0], as_it_is);
  EXPECT_EQ(turned_triangle("x,z,y")->triangles()[0], turned_over);
  // The triangles are those of a mesh that is mirrored already.
  EXPECT_EQ(turned_triangle("x,z,y", "x,z,y")->triangles()[0], as_it_is);
  EXPECT_EQ(turned_triangle("x,z,-y", "x,z,y")->triangles()[0], turned_over);
}

TEST(TurnedSource, TurnsNormalsAndKeepsTheValuesOfCorners) {
  const auto turned = [](const std::string& axes) {
    SourceAttributes attributes;
    attributes.sets.push_back({.name = "uv0",
                               .domain = AttributeDomain::kCorner,
                               .num_components = 2,
                               .values = {0, 0, 1, 0, 0, 1},
                               .value_of_corner = {0, 1, 2}});
    attributes.sets.push_back({.name = "normal",
                               .kind = SourceAttribute::Kind::kNormals,
                               .num_components = 3,
                               .values = {1, 2, 3, 4, 5, 6, 7, 8, 9}});
    attributes.rest_of_corner = {0, 1, 2};
    return turn_source(std::make_unique<OneTriangle>(std::nullopt, attributes),
                       *parse_axes(axes));
  };
  using Indices = std::vector<std::uint32_t>;
  const auto rotated = turned("x,z,-y");
  EXPECT_EQ(rotated->attributes().sets[0].value_of_corner, (Indices{0, 1, 2}));
  EXPECT_EQ(rotated->attributes().sets[0].values, (std::vector<float>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(rotated->attributes().sets[1].values,
            (std::vector<float>{1, 3, -2, 4, 6, -5, 7, 9, -8}));
  const auto mirrored = turned("x,z,y");
  EXPECT_EQ(mirrored->attributes().sets[0].value_of_corner, (Indices{0, 2, 1}));
  EXPECT_EQ(mirrored->attributes().rest_of_corner, (Indices{0, 2, 1}));
}

TEST(TurnedSource, HasTheAxesOfItsMeshOnceTurnedToThem) {
  EXPECT_FALSE(turned_triangle("x,z,-y", "x,z,-y")->axes_of_mesh());
  EXPECT_EQ(turned_triangle("x,-z,y", "x,z,-y")->axes_of_mesh(), *parse_axes("x,z,-y"));
}

}  // namespace
}  // namespace rlpc
