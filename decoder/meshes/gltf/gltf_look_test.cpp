#include "decoder/meshes/gltf/gltf_look.h"

#include <gtest/gtest.h>

#include "common/files/glb.h"

namespace rlpc {
namespace {

const std::vector<Triangle> kTriangles{{0, 1, 2}, {0, 2, 3}};

// Returns the materials of the two triangles.
std::vector<AttributeSet> materials(std::uint32_t first, std::uint32_t second) {
  std::vector<AttributeSet> sets(1);
  sets[0].header.name = "material";
  sets[0].header.domain = AttributeDomain::kTriangle;
  sets[0].values = {first, second};
  return sets;
}

std::string asset_of(const std::string& json) { return glb_head(json, 0); }

struct Written {
  GltfJson root = GltfJson::object();
  GltfJson primitives;
};

Written write(const std::vector<AttributeSet>& sets, const std::string& asset) {
  const GltfLook look(sets, kTriangles, 4, asset);
  EXPECT_EQ(look.problem(), "");
  GlbBuffers buffers;
  Written written;
  look.add_materials(written.root, buffers);
  written.primitives =
      primitives_of(look.mesh(), GltfJson::object(), GltfJson::array(), buffers);
  return written;
}

TEST(GltfLook, HasTheMaterialsOfTheAsset) {
  const Written written = write(
      materials(0, 1), asset_of(R"({"asset":{"version":"2.0"},"materials":[{"name":"a"}]})"));
  EXPECT_EQ(written.root["materials"], GltfJson::parse(R"([{"name":"a"}])"));
  ASSERT_EQ(written.primitives.size(), 2U);
  EXPECT_EQ(written.primitives[0]["material"], 0);
  EXPECT_FALSE(written.primitives[1].contains("material"));  // no other material exists
}

TEST(GltfLook, IsPlainWithoutAnAsset) {
  for (const auto& sets : {materials(0, 0), materials(3, 1), std::vector<AttributeSet>{}}) {
    const Written written = write(sets, "");
    ASSERT_EQ(written.root["materials"].size(), 1U);
    EXPECT_EQ(written.root["materials"][0]["doubleSided"], true);
    ASSERT_EQ(written.primitives.size(), 1U);
    EXPECT_EQ(written.primitives[0]["material"], 0);
  }
}

TEST(GltfLook, HasTheDefaultMaterialOfGltfWhereTheAssetSaysSo) {
  const Written written =
      write({}, asset_of(R"({"asset":{"version":"2.0"},"materials":[{}]})"));
  EXPECT_EQ(written.root["materials"], GltfJson::parse("[{}]"));
  ASSERT_EQ(written.primitives.size(), 1U);
  EXPECT_EQ(written.primitives[0]["material"], 0);
}

// Makes a set of four vertices, with consecutive values from 0 on.
AttributeSet vertices(const char* name, std::uint32_t components,
                      ValueKind kind = ValueKind::kIntegers) {
  AttributeSet set;
  set.header.name = name;
  set.header.domain = AttributeDomain::kVertex;
  set.header.kind = kind;
  set.header.num_components = components;
  set.header.value_bits = 8;
  for (std::uint32_t i = 0; i < 4 * components; ++i) set.values.push_back(i);
  return set;
}

GltfJson attributes_of(const std::vector<AttributeSet>& sets) {
  const GltfLook look(sets, kTriangles, 4, "");
  GlbBuffers buffers;
  GltfJson attributes = GltfJson::object();
  look.add_values(attributes, buffers);
  return attributes;
}

TEST(GltfLook, NumbersSetsWithoutGaps) {
  GltfJson attributes = attributes_of({vertices("uv2", 2), vertices("uv0", 2)});
  EXPECT_EQ(attributes.size(), 3U);
  EXPECT_NE(attributes["TEXCOORD_0"], attributes["TEXCOORD_1"]);
  EXPECT_EQ(attributes["TEXCOORD_1"], attributes["TEXCOORD_2"]);
  attributes = attributes_of({vertices("colour0", 3), vertices("colour2", 4)});
  EXPECT_EQ(attributes.size(), 1U);
  EXPECT_TRUE(attributes.contains("COLOR_0"));
}

TEST(GltfLook, LeavesOutSetsOfOtherNamesAndWidths) {
  EXPECT_TRUE(attributes_of({vertices("uv00", 2), vertices("uv", 2), vertices("uv0", 3),
                             vertices("uv4000000000", 2), vertices("uv1x", 2),
                             vertices("uv1", 2, ValueKind::kUnitVectors),
                             vertices("colour1", 3), vertices("colour0", 2)})
                  .empty());
}

}  // namespace
}  // namespace rlpc
