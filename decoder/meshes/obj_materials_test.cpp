#include "decoder/meshes/obj_materials.h"

#include <gtest/gtest.h>

#include "common/files/glb.h"
#include "decoder/meshes/mesh_bytes.h"

namespace rlpc {
namespace {

const std::string kPng = "\x89PNG the picture";

std::string glb_of(const std::string& json, std::string binary) {
  binary.resize((binary.size() + 3) / 4 * 4);
  return glb_head(json, binary.size()) + binary;
}

std::string with_views(const std::string& members, const std::string& views) {
  return glb_of(R"({"asset":{"version":"2.0"},"bufferViews":[)" + views + "]," + members + "}",
                kPng);
}

// Makes three triangles with two materials and two parts.
SinkOptions mesh_with(const std::string& asset) {
  SinkOptions options;
  options.num_vertices = 3;
  options.triangles = {{0, 1, 2}, {0, 1, 2}, {0, 1, 2}};
  AttributeSet material;
  material.header.name = "material";
  material.header.domain = AttributeDomain::kTriangle;
  material.values = {1, 0, 5};
  AttributeSet part = material;
  part.header.name = "part";
  part.values = {0, 1, 1};
  options.attributes = {material, part};
  options.asset = asset;
  return options;
}

constexpr const char* kMaterials = R"("materials":[
  {"name":"skin tone","alphaMode":"BLEND","pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,0.5],
   "roughnessFactor":0.75,"metallicFactor":0,"baseColorTexture":{"index":0}}},
  {"emissiveFactor":[1,0,0],"emissiveTexture":{"index":1}}],
  "textures":[{"source":0},{"source":1}],
  "images":[{"bufferView":0,"mimeType":"image/png"},{"bufferView":0}],
  "nodes":[{"name":"head"},{}])";

TEST(ObjMaterials, ComeFromTheAssetOfTheStream) {
  const SinkOptions options =
      mesh_with(with_views(kMaterials, R"({"buffer":0,"byteOffset":0,"byteLength":16})"));
  const ObjMaterials materials(options);
  const auto files = materials.files("walk");
  ASSERT_EQ(files.size(), 2U);  // both images are the same view
  EXPECT_EQ(files[0].name, "walk.mtl");
  EXPECT_EQ(files[0].bytes,
            "# materials of rlpcdec\n"
            "newmtl skin_tone\nKd 0.5 0.25 1\nd 0.5\nPr 0.75\nPm 0\nmap_Kd walk_0.png\n"
            "map_d walk_0.png\n"
            "newmtl material_1\nKd 1 1 1\nKe 1 0 0\nmap_Ke walk_0.png\n"
            "newmtl material_5\nKd 0.8 0.8 0.8\n");
  EXPECT_EQ(files[1].name, "walk_0.png");
  EXPECT_EQ(files[1].bytes, kPng);
  const std::string obj = make_mesh_bytes(SinkFormat::kObj, options, "walk.mtl")
                              ->frame(std::vector<std::int32_t>(9));
  EXPECT_NE(obj.find("g head\nusemtl material_1\nf 1 2 3\ng part_1\nusemtl skin_tone\nf"),
            std::string::npos)
      << obj;
}

TEST(ObjMaterials, ImagesOfExtensionsAreFound) {
  constexpr const char* kWebp = R"("materials":[
    {"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5],"baseColorTexture":{"index":0}}}],
    "textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}],"images":[{"bufferView":0}])";
  const SinkOptions options =
      mesh_with(with_views(kWebp, R"({"buffer":0,"byteOffset":0,"byteLength":16})"));
  const auto files = ObjMaterials(options).files("walk");
  ASSERT_EQ(files.size(), 2U);
  // The material is opaque, whatever its alpha.
  EXPECT_NE(files[0].bytes.find("\nKd 1 1 1\nmap_Kd walk_0.png\nnewmtl"), std::string::npos)
      << files[0].bytes;
}

AttributeSet coordinates(const std::string& name, std::uint32_t first) {
  AttributeSet set;
  set.header.name = String(name.begin(), name.end());
  set.header.domain = AttributeDomain::kVertex;
  set.header.num_components = 2;
  set.header.value_bits = 8;
  set.header.scale = ValueScale::kGrid;
  set.header.log2_step = -2;
  set.values = {first, 0, first + 1, 0, first, 2};
  return set;
}

TEST(ObjMaterials, FacesHaveTheCoordinatesOfTheirImage) {
  SinkOptions options = mesh_with(with_views(R"("materials":[
    {"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}}},
    {"emissiveTexture":{"index":0,"extensions":{"KHR_texture_transform":
      {"texCoord":1,"offset":[0.5,0.25],"scale":[2,1],"rotation":0}}}},
    {},{},{},{"normalTexture":{"index":0,"texCoord":7}}],
    "textures":[{"source":0}],"images":[{"bufferView":0}])",
                                             R"({"buffer":0,"byteOffset":0,"byteLength":16})"));
  options.attributes.push_back(coordinates("uv0", 0));
  options.attributes.push_back(coordinates("uv1", 2));
  const std::string obj =
      make_mesh_bytes(SinkFormat::kObj, options, "")->frame(std::vector<std::int32_t>(9));
  // Triangles of materials 1 (moved), 0, and 5, whose set is missing.
  EXPECT_NE(obj.find("vt 1.5 0.75\nvt 2 0.75\nvt 1.5 0.25\nvt 0.5 1\nvt 0.75 1\nvt 0.5 0.5\n"),
            std::string::npos)
      << obj;
  EXPECT_NE(obj.find("f 1/1 2/2 3/3\n"), std::string::npos);
  EXPECT_NE(obj.find("f 1/4 2/5 3/6\n"), std::string::npos);
  EXPECT_NE(obj.find("f 1 2 3\n"), std::string::npos);
}

TEST(ObjMaterials, WithoutNumbersTheFirstIsThatOfAllTriangles) {
  SinkOptions options =
      mesh_with(with_views(kMaterials, R"({"buffer":0,"byteOffset":0,"byteLength":16})"));
  options.attributes.clear();
  const auto files = ObjMaterials(options).files("a");
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].bytes.find("material_1"), std::string::npos);
  const std::string obj =
      make_mesh_bytes(SinkFormat::kObj, options, "a.mtl")->frame(std::vector<std::int32_t>(9));
  EXPECT_NE(obj.find("usemtl skin_tone\nf 1 2 3\nf 1 2 3\n"), std::string::npos);
}

TEST(ObjMaterials, NeedNoAsset) {
  const auto files = ObjMaterials(mesh_with("")).files("a");
  ASSERT_EQ(files.size(), 1U);
  EXPECT_NE(files[0].bytes.find("newmtl material_0\nKd 0.8 0.8 0.8\n"), std::string::npos);
}

TEST(StreamAsset, WhatIsNoGlbIsLeftOut) {
  const std::string good = with_views(kMaterials, R"({"byteLength":16})");
  EXPECT_EQ(StreamAsset("").problem(), "");
  EXPECT_EQ(StreamAsset(good).problem(), "");
  EXPECT_TRUE(StreamAsset(good).root().is_object());
  const std::string deep = std::string(100000, '[') + std::string(100000, ']');
  for (const std::string& bad :
       {std::string("PK"), std::string("glTF"), good.substr(0, 40), glb_of("{", ""),
        glb_of("[]", ""), glb_of(R"({"images":7})", ""),
        glb_of(R"({"nodes":)" + deep + "}", "")}) {
    const StreamAsset asset(bad);
    EXPECT_NE(asset.problem(), "") << bad.substr(0, 40);
    EXPECT_TRUE(asset.root().is_null());
    EXPECT_EQ(ObjMaterials(mesh_with(bad)).files("a").size(), 1U);
  }
}

// glTF allows no null materials and no references to missing objects.
TEST(StreamAsset, BrokenPartsAreLeftOutAndNamed) {
  const std::string bad = glb_of(
      R"({"materials":[{"name":"a","normalTexture":{"index":-1},"pbrMetallicRoughness":
      {"baseColorTexture":{"index":0}}},null,
      {"extensions":{"X":{"coatTexture":{"index":7}}},"emissiveTexture":3}],
      "textures":[{"source":0,"sampler":1},{"source":99999999999}],"images":[7]})",
      "");
  const StreamAsset asset(bad);
  for (const char* place :
       {"materials[1]", "images[0]", "textures[0].sampler", "textures[1].source"}) {
    EXPECT_NE(asset.problem().find(place), std::string::npos) << place << asset.problem();
  }
  EXPECT_EQ(asset.root()["materials"].dump(),
            R"([{"name":"a","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}},{},)"
            R"({"extensions":{"X":{}}}])");
  EXPECT_EQ(asset.root()["textures"].dump(), R"([{"source":0},{}])");
  SinkOptions options = mesh_with(bad);
  options.attributes.clear();
  const auto mesh = make_mesh_bytes(SinkFormat::kObj, options, "a.mtl");
  EXPECT_EQ(left_out_remark(SinkFormat::kObj, options, *mesh).size(), 1U);
}

TEST(StreamAsset, SmallStreamsMakeNoLargeFiles) {
  const StreamAsset asset(with_views(R"("images":[{"bufferView":0},{"bufferView":1}])",
                                     R"({"byteLength":16},{"byteLength":16})"));
  EXPECT_NE(asset.problem().find("overlap"), std::string::npos);
}

TEST(StreamAsset, ViewsOutsideAreEmpty) {
  const StreamAsset asset(
      with_views(R"("images":[{"bufferView":0},{"bufferView":9},{"bufferView":-1},7])",
                 R"({"byteOffset":4,"byteLength":4294967295})"));
  EXPECT_EQ(asset.view_of(asset.root()["images"][0]), 0U);
  EXPECT_EQ(asset.view_bytes(0), "");
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_FALSE(asset.view_of(asset.root()["images"][i]).has_value()) << i;
  }
}

}  // namespace
}  // namespace rlpc
