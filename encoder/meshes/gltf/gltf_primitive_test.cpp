#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/primitive.h"
#include "encoder/testing/gltf_files.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

class GltfPrimitiveTest : public GltfFilesTest {};

TEST_F(GltfPrimitiveTest, ReadsEveryKindOfTriangles) {
  const std::map<int, std::vector<Triangle>> expected{
      {4, {{0, 1, 2}, {3, 4, 5}}},
      {5, {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}},
      {6, {{1, 2, 0}, {2, 3, 0}, {3, 4, 0}, {4, 5, 0}}}};
  for (const auto& [mode, triangles] : expected) {
    GltfBuilder builder;
    std::vector<float> xyz(18);
    for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] = static_cast<float>(i);
    Json primitive{{"attributes", {{"POSITION", builder.add("VEC3", xyz)}}}, {"mode", mode}};
    const std::size_t mesh = builder.add_mesh(primitive);
    builder.add_root({{"mesh", mesh}});
    EXPECT_EQ(open(builder)->triangles(), triangles);
    const auto indices = builder.add("SCALAR", std::vector<std::uint8_t>{0, 1, 2, 3, 4, 5});
    builder.json["meshes"][0]["primitives"][0]["indices"] = indices;
    EXPECT_EQ(open(builder)->triangles(), triangles);
  }
}

TEST_F(GltfPrimitiveTest, DropsPointsAndLinesWithANote) {
  GltfBuilder builder = one_triangle();
  for (const int mode : {0, 1, 2, 3}) {
    builder.json["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", 0}}}, {"mode", mode}});
  }
  const auto source = open(builder);
  EXPECT_EQ(source->num_vertices(), 3U);
  EXPECT_EQ(source->notes(), (std::vector<std::string>{"dropped 4 point or line primitives"}));
}

// Two targets: the first moves vertex 1 along y, the second moves all vertices along z.
GltfBuilder with_targets() {
  GltfBuilder builder = one_triangle();
  const std::size_t up = builder.add("VEC3", std::vector<float>{0, 0, 0, 0, 4, 0, 0, 0, 0});
  const std::size_t out = builder.add("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
  builder.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}},
                                                           {{"POSITION", out}}};
  return builder;
}

TEST_F(GltfPrimitiveTest, AddsMorphTargetsByTheWeightsOfNodeOrMesh) {
  GltfBuilder builder = with_targets();
  EXPECT_EQ(frame_of(*open(builder), 0), kCorners);
  builder.json["meshes"][0]["weights"] = {0.5, 0};
  EXPECT_EQ(frame_of(*open(builder), 0), (std::vector<float>{0, 0, 0, 1, 2, 0, 0, 1, 0}));
  builder.json["nodes"][0]["weights"] = {-1, 2};
  EXPECT_EQ(frame_of(*open(builder), 0), (std::vector<float>{0, 0, 2, 1, -4, 2, 0, 1, 2}));
}

TEST_F(GltfPrimitiveTest, TurnsNormalsByMorphTargetsThenByNodes) {
  GltfBuilder builder = with_targets();
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] =
      builder.add("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
  primitive["targets"][1]["NORMAL"] =
      builder.add("VEC3", std::vector<float>{0, 0, 0, 0, 2, -2, 0, 0, 0});
  builder.json["meshes"][0]["weights"] = {1, 0.5};      // the first target turns no normal
  builder.json["nodes"][0]["rotation"] = {0, 0, 1, 0};  // half a turn
  const auto source = open(builder);
  const SourceAttributes& all = source->attributes();
  ASSERT_EQ(all.sets[0].name, "normal");
  EXPECT_EQ(all.sets[0].values, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}));
  expect_near(all.first_normals, {0, 0, 1, 0, -1, 0, 0, 0, 1});
}

TEST_F(GltfPrimitiveTest, AnimatesWeightsWithEveryInterpolation) {
  const std::map<std::string, float> at_a_quarter{
      {"STEP", 0}, {"LINEAR", 0.25}, {"CUBICSPLINE", 0.15625}};
  for (const auto& [how, weight] : at_a_quarter) {
    GltfBuilder builder = with_targets();
    builder.push("animations", Json::object());
    std::vector<float> values{0, 8, 1, 8};
    if (how == "CUBICSPLINE") values = {9, 9, 0, 8, 0, 0, 0, 0, 1, 8, 9, 9};
    const std::size_t input = builder.add("SCALAR", std::vector<float>{0, 1});
    builder.add_channel(0, "weights", input, builder.add("SCALAR", values), how.c_str());
    const std::vector<float> xyz = frame_of(*open(builder, {}, false, {4, 1}), 1);
    EXPECT_FLOAT_EQ(xyz[4], 4 * weight) << how;
    EXPECT_FLOAT_EQ(xyz[5], 8) << how;
  }
}

TEST_F(GltfPrimitiveTest, ReadsSparseAccessors) {
  GltfBuilder builder = with_targets();
  const std::size_t at = builder.add_view(std::vector<std::uint8_t>{0, 2});
  const std::size_t values = builder.add_view(std::vector<float>{5, 6, 7, 8, 9, 10});
  const Json sparse{{"count", 2},
                    {"indices", {{"bufferView", at}, {"componentType", 5121}}},
                    {"values", {{"bufferView", values}}}};
  builder.json["accessors"][0]["sparse"] = sparse;
  builder.json["meshes"][0]["weights"] = {1, 0};
  EXPECT_EQ(frame_of(*open(builder), 0), (std::vector<float>{5, 6, 7, 1, 4, 0, 8, 9, 10}));
  // Sparse values replace the base values of targets, or zeros.
  builder.json["accessors"][0].erase("sparse");
  builder.json["accessors"][1]["sparse"] = sparse;
  EXPECT_EQ(frame_of(*open(builder), 0), (std::vector<float>{5, 6, 7, 1, 4, 0, 8, 10, 10}));
  builder.json["accessors"][1].erase("bufferView");
  EXPECT_EQ(frame_of(*open(builder), 0), (std::vector<float>{5, 6, 7, 1, 0, 0, 8, 10, 10}));
  // Targets with only zeros.
  builder.json["accessors"][1].erase("sparse");
  EXPECT_EQ(frame_of(*open(builder), 0), kCorners);
  builder.json["accessors"][0].erase("bufferView");
  EXPECT_EQ(frame_of(*open(builder), 0), std::vector<float>(9));
}

TEST_F(GltfPrimitiveTest, ReadsIntegersOfKhrMeshQuantization) {
  const auto positions_of = [&](const auto& integers, bool normalized) {
    GltfBuilder builder;
    builder.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    builder.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::size_t accessor =
        normalized ? builder.add_normalized("VEC3", integers) : builder.add("VEC3", integers);
    builder.add_root({{"mesh", builder.add_mesh({{"attributes", {{"POSITION", accessor}}}})}});
    return frame_of(*open(builder), 0);
  };
  const std::vector<std::int8_t> i8{-128, 127, 0, -127, 1, -1, 2, 0, 0};
  EXPECT_EQ(positions_of(i8, false), (std::vector<float>{-128, 127, 0, -127, 1, -1, 2, 0, 0}));
  expect_near(positions_of(i8, true),
              {-1, 1, 0, -1, 1 / 127.0F, -1 / 127.0F, 2 / 127.0F, 0, 0});
  const std::vector<std::uint8_t> u8{255, 51, 0, 0, 0, 1, 0, 0, 128};
  EXPECT_EQ(positions_of(u8, false), (std::vector<float>{255, 51, 0, 0, 0, 1, 0, 0, 128}));
  expect_near(positions_of(u8, true), {1, 0.2F, 0, 0, 0, 1 / 255.0F, 0, 0, 128 / 255.0F});
  const std::vector<std::int16_t> i16{-32768, 32767, 0, -32767, 0, 1, 0, 256, 0};
  EXPECT_EQ(positions_of(i16, false),
            (std::vector<float>{-32768, 32767, 0, -32767, 0, 1, 0, 256, 0}));
  expect_near(positions_of(i16, true), {-1, 1, 0, -1, 0, 1 / 32767.0F, 0, 256 / 32767.0F, 0});
  const std::vector<std::uint16_t> u16{65535, 1, 0, 0, 0, 32768, 2, 3, 4};
  EXPECT_EQ(positions_of(u16, false), (std::vector<float>{65535, 1, 0, 0, 0, 32768, 2, 3, 4}));
  expect_near(positions_of(u16, true), {1, 1 / 65535.0F, 0, 0, 0, 32768 / 65535.0F,
                                        2 / 65535.0F, 3 / 65535.0F, 4 / 65535.0F});
}

TEST_F(GltfPrimitiveTest, FollowsStrides) {
  GltfBuilder builder;
  const std::vector<float> both{0, 0, 0, 9, 1, 0,
                                0, 9, 0, 1, 0, 9};  // an unused number in between
  builder.add("VEC3", both);
  builder.json["bufferViews"][0]["byteStride"] = 16;
  builder.json["accessors"][0]["count"] = 3;
  builder.add_root({{"mesh", builder.add_mesh({{"attributes", {{"POSITION", 0}}}})}});
  EXPECT_EQ(frame_of(*open(builder), 0), kCorners);
}

TEST_F(GltfPrimitiveTest, ColoursKeepTheirBitsAndAreWhiteWhereThereAreNone) {
  GltfBuilder builder = one_triangle();
  const std::vector<std::uint16_t> colours{0, 256, 65535, 1, 2, 3, 4, 5, 6};
  Json& primitives = builder.json["meshes"][0]["primitives"];
  primitives[0]["attributes"]["COLOR_0"] = builder.add_normalized("VEC3", colours);
  primitives.push_back({{"attributes", {{"POSITION", 0}}}});
  const auto source = open(builder);
  ASSERT_EQ(source->attributes().sets.size(), 1U);
  const SourceAttribute& set = source->attributes().sets[0];
  EXPECT_EQ(set.name, "colour0");
  EXPECT_EQ(set.max_value, 65535U);
  std::vector<float> expected(colours.begin(), colours.end());
  expected.insert(expected.end(), 9, 65535.0F);
  EXPECT_EQ(set.values, expected);
}

TEST_F(GltfPrimitiveTest, EqualTextureCoordinatesAreReadOnce) {
  GltfBuilder builder = one_triangle();
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["TEXCOORD_0"] = builder.add("VEC2", std::vector<float>{0, 0, 1, 0, 0, 1});
  attributes["TEXCOORD_1"] = builder.add("VEC2", std::vector<float>{0, 0, 1, 0, 0, 0.5F});
  attributes["TEXCOORD_2"] = builder.add("VEC2", std::vector<float>{0, 0, 1, 0, 0, 1});
  const auto source = open(builder);
  ASSERT_EQ(source->attributes().sets.size(), 2U);
  EXPECT_EQ(source->attributes().sets[0].name, "uv0");
  EXPECT_EQ(source->attributes().sets[1].name, "uv1");
  EXPECT_EQ(source->notes(),
            (std::vector<std::string>{"TEXCOORD_2 is equal to TEXCOORD_0: coded once"}));
}

TEST_F(GltfPrimitiveTest, ReadsMoreThan64KiBOfAnAccessor) {
  GltfBuilder builder;
  std::vector<float> xyz(3 * std::size_t{9000});
  for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] = static_cast<float>(i);
  builder.add_root(
      {{"mesh", builder.add_mesh({{"attributes", {{"POSITION", builder.add("VEC3", xyz)}}}})}});
  EXPECT_EQ(frame_of(*open(builder), 0), xyz);
}

// Builds a triangle that follows two joints, 10 along x and 20 along y; the bind pose is at x -
// 1.
GltfBuilder with_skin(const std::vector<std::uint8_t>& joints,
                      const std::vector<float>& weights) {
  GltfBuilder builder = one_triangle();
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = builder.add("VEC4", joints);
  attributes["WEIGHTS_0"] = builder.add("VEC4", weights);
  builder.add_root({{"translation", {10, 0, 0}}});
  builder.add_root({{"translation", {0, 20, 0}}});
  std::vector<float> inverse;
  for (int joint = 0; joint < 2; ++joint) {
    inverse.insert(inverse.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1});
  }
  builder.push("skins",
               {{"joints", {1, 2}}, {"inverseBindMatrices", builder.add("MAT4", inverse)}});
  builder.json["nodes"][0]["skin"] = 0;
  builder.json["nodes"][0]["translation"] = {1000, 0, 0};  // ignored by skins
  return builder;
}

TEST_F(GltfPrimitiveTest, FollowsJointsByWeight) {
  const GltfBuilder builder = with_skin({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
                                        {1, 0, 0, 0, 1, 0, 0, 0, .25F, .75F, 0, 0});
  EXPECT_EQ(frame_of(*open(builder), 0), (std::vector<float>{11, 0, 0, 2, 20, 0, 8.5F, 6, 0}));
}

TEST_F(GltfPrimitiveTest, WeightsNeedNotAddUpToOne) {
  const GltfBuilder builder =
      with_skin({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, {3, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(frame_of(*open(builder), 0),  // no weights: the first joint
            (std::vector<float>{11, 0, 0, 7, 10, 0, 1, 21, 0}));
}

TEST_F(GltfPrimitiveTest, ReadsSeveralSetsOfJoints) {
  GltfBuilder builder =
      with_skin(std::vector<std::uint8_t>(12), {.5F, 0, 0, 0, .5F, 0, 0, 0, 1, 0, 0, 0});
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_1"] =
      builder.add("VEC4", std::vector<std::uint16_t>{1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 1, 1});
  attributes["WEIGHTS_1"] = builder.add_normalized(
      "VEC4", std::vector<std::uint16_t>{65535, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  expect_near(frame_of(*open(builder), 0), {1 + 10 / 3.0F, 40 / 3.0F, 0, 12, 0, 0, 11, 1, 0});
}

TEST_F(GltfPrimitiveTest, BindsToTheNodePoseWithoutInverseMatrices) {
  GltfBuilder builder =
      with_skin(std::vector<std::uint8_t>(12), {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  builder.json["skins"][0].erase("inverseBindMatrices");
  EXPECT_EQ(frame_of(*open(builder), 0), (std::vector<float>{10, 0, 0, 11, 0, 0, 10, 1, 0}));
}

TEST_F(GltfPrimitiveTest, AppliesSkinsAfterMorphTargets) {
  GltfBuilder builder =
      with_skin(std::vector<std::uint8_t>(12, 1), {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  builder.json["nodes"][2]["rotation"] = {0, 0, 1, 0};  // half a turn
  const std::size_t up = builder.add("VEC3", std::vector<float>{0, 0, 0, 0, 4, 0, 0, 0, 0});
  builder.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}};
  builder.json["meshes"][0]["weights"] = {1};
  expect_near(frame_of(*open(builder), 0), {-1, 20, 0, -2, 16, 0, -1, 19, 0});
}

TEST_F(GltfPrimitiveTest, AnimatesJointsOutsideTheScene) {
  GltfBuilder builder =
      with_skin(std::vector<std::uint8_t>(12), {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  builder.json["scenes"][0]["nodes"] = {0};
  builder.push("animations", Json::object());
  const std::size_t input = builder.add("SCALAR", std::vector<float>{0, 1});
  const std::size_t output = builder.add("VEC3", std::vector<float>{0, 0, 0, 0, 0, 8});
  builder.add_channel(1, "translation", input, output, "LINEAR");
  EXPECT_EQ(frame_of(*open(builder, {}, false, {2, 1}), 1),
            (std::vector<float>{1, 0, 4, 2, 0, 4, 1, 1, 4}));
}

TEST_F(GltfPrimitiveTest, AlwaysDropsTrianglesWithoutThreeDistinctCorners) {
  GltfBuilder builder = one_triangle();
  builder.json["meshes"][0]["primitives"][0]["indices"] =
      builder.add("SCALAR", std::vector<std::uint32_t>{0, 1, 1, 2, 1, 0});
  const auto source = open(builder);
  EXPECT_EQ(source->triangles(), (std::vector<Triangle>{{2, 1, 0}}));
  EXPECT_EQ(source->notes(), (std::vector<std::string>{"dropped 1 degenerate triangle"}));
}

}  // namespace
}  // namespace rlpc
