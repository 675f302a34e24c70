// Tests the contents of glTF files that the asset of a stream keeps.
#include <nlohmann/json.hpp>

#include "common/files/binary_numbers.h"
#include "encoder/testing/gltf_files.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

Json asset_of(const FrameSource& source) {
  const std::string& glb = source.asset();
  EXPECT_TRUE(glb.starts_with("glTF"));
  return Json::parse(glb.substr(20, load_u32(glb, 12)));
}

class GltfAssetTest : public GltfFilesTest {
 protected:
  void SetUp() override {
    GltfFilesTest::SetUp();
    put("there.png", "\x89PNG picture");
    builder_.json["images"] = {{{"uri", "missing.png"}}, {{"uri", "there.png"}}};
    builder_.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
  }
  Json& add_material() { return builder_.json["materials"].emplace_back(); }

  GltfBuilder builder_ = one_triangle();
};

TEST_F(GltfAssetTest, ImagesThatCannotBeReadAreLeftOut) {
  Json& material = add_material();
  material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  material["normalTexture"] = {{"index", 1}};
  const auto source = open(builder_);
  ASSERT_EQ(source->notes().size(), 1U);
  expect_text(source->notes()[0], "texture images[0] is not carried");
  expect_text(source->notes()[0], "images[0].uri");
  const Json asset = asset_of(*source);
  ASSERT_EQ(asset["images"].size(), 1U);
  EXPECT_EQ(asset["images"][0]["mimeType"], "image/png");
  EXPECT_EQ(asset["textures"], Json::parse(R"([{}, {"source": 0}])"));
  EXPECT_EQ(asset["materials"][0]["normalTexture"], Json({{"index", 1}}));
  EXPECT_FALSE(asset["materials"][0]["pbrMetallicRoughness"].contains("baseColorTexture"));
}

TEST_F(GltfAssetTest, ImagesOfExtensionsStayInPlaceOfOthers) {
  builder_.json["textures"][0]["extensions"]["EXT_texture_webp"] = {{"source", 1}};
  add_material()["emissiveTexture"] = {{"index", 0}};
  const Json asset = asset_of(*open(builder_));
  EXPECT_EQ(asset["textures"][0]["extensions"]["EXT_texture_webp"], Json({{"source", 0}}));
  EXPECT_FALSE(asset["textures"][0].contains("source"));
  EXPECT_EQ(asset["materials"][0]["emissiveTexture"], Json({{"index", 0}}));
}

TEST_F(GltfAssetTest, TexturesThatAreNotThereAreLeftOut) {
  builder_.json["images"].erase(0);
  builder_.json["textures"] = {{{"source", 0}}};
  add_material()["emissiveTexture"] = {{"index", 9}};
  add_material()["emissiveTexture"] = {{"index", 0}};
  add_material()["emissiveTexture"] = Json::object();
  const auto source = open(builder_);
  EXPECT_EQ(source->notes(), (std::vector<std::string>{"materials: left out 2 textures that "
                                                       "the file does not have (it has 1)"}));
  const Json asset = asset_of(*source);
  EXPECT_FALSE(asset["materials"][0].contains("emissiveTexture"));
  EXPECT_TRUE(asset["materials"][1].contains("emissiveTexture"));
  EXPECT_FALSE(asset["materials"][2].contains("emissiveTexture"));
}

TEST_F(GltfAssetTest, TrianglesWithoutMaterialHaveThatOfGltf) {
  builder_.json.erase("images");
  builder_.json.erase("textures");
  add_material()["name"] = "red";
  Json& primitives = builder_.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  primitives[1]["material"] = 0;
  const auto source = open(builder_);
  EXPECT_EQ(asset_of(*source)["materials"], Json::parse(R"([{"name": "red"}, {}])"));
  const auto& sets = source->attributes().sets;
  ASSERT_EQ(sets.size(), 1U);
  EXPECT_EQ(sets[0].name, "material");
  EXPECT_EQ(sets[0].values, (std::vector<float>{1.0F, 0.0F}));
  primitives[0]["material"] = 0;
  EXPECT_EQ(asset_of(*open(builder_))["materials"].size(), 1U);
}

}  // namespace
}  // namespace rlpc
