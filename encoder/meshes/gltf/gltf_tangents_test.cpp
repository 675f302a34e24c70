#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "encoder/meshes/gltf/tangents.h"
#include "encoder/testing/gltf_files.h"

namespace rlpc {
namespace {

// A square in the plane z = 0 whose image is upright: coordinates go right and down.
struct Square {
  std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  std::vector<float> positions{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  std::vector<float> normals{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
  std::vector<float> uv{0, 1, 1, 1, 1, 0, 0, 0};
  std::vector<float> tangents;

  TangentCount count(const std::array<float, 4>& tangent) {
    tangents.clear();
    for (int i = 0; i < 4; ++i) tangents.insert(tangents.end(), tangent.begin(), tangent.end());
    return compare_tangents({triangles, positions, normals, uv, tangents});
  }
};

void expect(const TangentCount& found, std::uint64_t apart, std::uint64_t inverted) {
  EXPECT_EQ(found.corners, 6U);
  EXPECT_EQ(found.apart, apart);
  EXPECT_EQ(found.inverted, inverted);
}

TEST(Tangents, ThoseOfTextureCoordinatesAreEqual) {
  Square square;
  expect(square.count({1, 0, 0, 1}), 0, 0);
  expect(square.count({2, 0.1F, 0.5F, 1}), 0, 0);  // any length, and off the surface
  EXPECT_EQ(tangent_note(square.count({1, 0, 0, 1})), "");
}

TEST(Tangents, OthersAreCounted) {
  Square square;
  expect(square.count({1, 1, 0, 1}), 6, 0);
  expect(square.count({-1, 0, 0, 1}), 6, 6);
  expect(square.count({1, 0, 0, -1}), 6, 6);
  const std::string note = tangent_note(square.count({-1, 0, 0, 1}));
  EXPECT_NE(note.find("100 %"), std::string::npos) << note;
  EXPECT_NE(note.find("dents become bumps"), std::string::npos) << note;
}

TEST(Tangents, MirroredImagesHaveTheOtherHand) {
  Square square;
  square.uv = {1, 1, 0, 1, 0, 0, 1, 0};
  expect(square.count({-1, 0, 0, -1}), 0, 0);
  expect(square.count({1, 0, 0, 1}), 6, 6);
}

TEST(Tangents, CoordinatesWithoutAreaAreNotCompared) {
  Square square;
  square.uv.assign(8, 0.5F);
  EXPECT_EQ(square.count({1, 0, 0, 1}).corners, 0U);
}

// A ball with the coordinates of a map, and the tangents that a bake of it would have.
TEST(Tangents, CurvedSurfacesHaveMeansOfTheirTriangles) {
  constexpr std::uint32_t kColumns = 24;
  constexpr std::uint32_t kRows = 12;
  Square ball;
  ball.triangles.clear();
  ball.positions.clear();
  ball.uv.clear();
  for (std::uint32_t j = 0; j <= kRows; ++j) {
    for (std::uint32_t i = 0; i <= kColumns; ++i) {
      const float u = 6.2831853F * static_cast<float>(i) / kColumns;
      const float v = 0.5F + 2.0F * static_cast<float>(j) / kRows;
      for (const float x :
           {std::cos(u) * std::sin(v), std::cos(v), -std::sin(u) * std::sin(v)}) {
        ball.positions.push_back(x);
      }
      ball.uv.push_back(static_cast<float>(i) / kColumns);
      ball.uv.push_back(static_cast<float>(j) / kRows);
      for (const float x : {-std::sin(u), 0.0F, -std::cos(u), 1.0F}) ball.tangents.push_back(x);
      if (i == kColumns || j == kRows) continue;
      const std::uint32_t a = j * (kColumns + 1) + i;
      ball.triangles.push_back({a, a + kColumns + 1, a + kColumns + 2});
      ball.triangles.push_back({a, a + kColumns + 2, a + 1});
    }
  }
  ball.normals = ball.positions;
  const TangentCount found =
      compare_tangents({ball.triangles, ball.positions, ball.normals, ball.uv, ball.tangents});
  EXPECT_EQ(found.corners, 3 * ball.triangles.size());
  EXPECT_EQ(found.inverted, 0U);
  EXPECT_EQ(found.apart, 0U);
}

class TangentFiles : public GltfFilesTest {
 protected:
  // Builds a triangle with these tangents, in a material with or without a normal map.
  static GltfBuilder triangle(const std::vector<float>& tangents, bool has_relief) {
    GltfBuilder builder = one_triangle();
    auto& primitive = builder.json["meshes"][0]["primitives"][0];
    auto& attributes = primitive["attributes"];
    attributes["NORMAL"] = builder.add("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
    attributes["TEXCOORD_0"] = builder.add("VEC2", std::vector<float>{0, 1, 1, 1, 0, 0});
    attributes["TANGENT"] = builder.add("VEC4", tangents);
    builder.json["materials"].push_back(nlohmann::json::object());
    if (has_relief) builder.json["materials"][0]["normalTexture"] = {{"index", 0}};
    builder.json["textures"].push_back(nlohmann::json::object());
    primitive["material"] = 0;
    return builder;
  }

  bool is_noted(const GltfBuilder& builder) {
    const auto source = open(builder);
    for (const std::string& note : source->notes()) {
      if (note.find("dents become bumps") != std::string::npos) return true;
    }
    return false;
  }
};

const std::vector<float> kOther{-1, 0, 0, 1, -1, 0, 0, 1, -1, 0, 0, 1};

TEST_F(TangentFiles, OtherTangentsAreNotedWhereThereIsRelief) {
  EXPECT_TRUE(is_noted(triangle(kOther, true)));
  EXPECT_FALSE(is_noted(triangle(kOther, false)));
  EXPECT_FALSE(is_noted(triangle({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, true)));
}

TEST_F(TangentFiles, OtherTangentsAreNotedWhereExtensionsNeedThem) {
  const auto noted_with = [&](const char* extensions) {
    GltfBuilder builder = triangle(kOther, false);
    builder.json["materials"][0]["extensions"] = nlohmann::json::parse(extensions);
    return is_noted(builder);
  };
  EXPECT_TRUE(noted_with(R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.6}})"));
  EXPECT_TRUE(noted_with(
      R"({"KHR_materials_anisotropy": {"anisotropyTexture": {"index": 0, "texCoord": 0}}})"));
  EXPECT_TRUE(
      noted_with(R"({"KHR_materials_clearcoat": {"clearcoatNormalTexture": {"index": 0}}})"));
  EXPECT_FALSE(noted_with(R"({"KHR_materials_clearcoat": {"clearcoatFactor": 1}})"));
  EXPECT_FALSE(noted_with(R"({"KHR_materials_clearcoat": 3})"));
}

}  // namespace
}  // namespace rlpc
