#include "encoder/meshes/materials/material_asset.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/files/binary_numbers.h"
#include "encoder/meshes/materials/material_files.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

class MaterialAssetTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_ / "maps");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  MaterialAsset make(std::vector<std::string> names, const std::string& mtl,
                     Images images = Images::kExact, std::uint64_t max_bytes = 1U << 20) const {
    SourceMaterials materials;
    materials.names = std::move(names);
    materials.mtl = mtl;
    return make_material_asset(materials, folder_.string(), images, max_bytes);
  }
  static Json json_of(const std::string& glb) {
    EXPECT_TRUE(glb.starts_with("glTF"));
    return Json::parse(glb.substr(20, load_u32(glb, 12)));
  }

  std::filesystem::path folder_;
};

const std::string kPng = "\x89PNG picture";

TEST_F(MaterialAssetTest, NothingIsKeptOfNothing) {
  EXPECT_EQ(make({}, "").glb, "");
  EXPECT_EQ(make({"a"}, "newmtl b\nKd 1 1 1\n").glb, "");
}

TEST_F(MaterialAssetTest, MaterialsComeInTheOrderOfTheirNumbers) {
  const auto made = make({"glass", "unknown", "red"},
                         "newmtl red\nKd 0.8 0.1 x\nPr 0.25\nPm 1\nKe 2\n"
                         "newmtl glass\nKd .5\nTr 0.75\nNs 198\n");
  EXPECT_EQ(
      made.notes,
      (std::vector<std::string>{"dropped: parameters of materials (Kd, Ke outside 0 to 1)"}));
  const Json root = json_of(made.glb);
  ASSERT_EQ(root["materials"].size(), 3U);
  const Json& glass = root["materials"][0];
  EXPECT_EQ(glass["name"], "glass");
  EXPECT_EQ(glass["alphaMode"], "BLEND");
  EXPECT_EQ(glass["pbrMetallicRoughness"]["baseColorFactor"], Json({0.5, 0.5, 0.5, 0.25}));
  EXPECT_EQ(glass["pbrMetallicRoughness"]["roughnessFactor"], 0.1);
  EXPECT_EQ(root["materials"][1], Json({{"doubleSided", true},
                                        {"name", "unknown"},
                                        {"pbrMetallicRoughness", {{"metallicFactor", 0.0}}}}));
  const Json& red = root["materials"][2];
  EXPECT_EQ(red["pbrMetallicRoughness"]["baseColorFactor"], Json({0.8, 0.1, 0.8, 1.0}));
  EXPECT_EQ(red["pbrMetallicRoughness"]["metallicFactor"], 1.0);
  EXPECT_EQ(red["emissiveFactor"], Json({1.0, 1.0, 1.0}));
}

TEST_F(MaterialAssetTest, ImagesAreCarriedOnce) {
  write("maps/skin.png", kPng);
  write("bumps.jpg", "\xFF\xD8\xFF normals");
  const auto made = make({"a", "b"},
                         "newmtl a\nKd 0.2 0.2 0.2\nmap_Kd -s 1 1 1 maps\\skin.png\n"
                         "norm bumps.jpg\nnewmtl b\nmap_Ke maps\\skin.png\n");
  EXPECT_EQ(made.notes, (std::vector<std::string>{
                            "dropped: parameters of materials (Kd where map_Kd is given)"}));
  EXPECT_EQ(made.files.size(), 2U);
  const Json root = json_of(made.glb);
  EXPECT_EQ(root["images"].size(), 2U);
  EXPECT_EQ(root["images"][0]["mimeType"], "image/png");
  const Json& a = root["materials"][0];
  EXPECT_FALSE(a["pbrMetallicRoughness"].contains("baseColorFactor"));
  EXPECT_EQ(a["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
  EXPECT_EQ(a["normalTexture"]["index"], 1);
  EXPECT_EQ(root["materials"][1]["emissiveTexture"]["index"], 0);
  EXPECT_EQ(root["materials"][1]["emissiveFactor"], Json({1.0, 1.0, 1.0}));
  EXPECT_NE(made.glb.find(kPng), std::string::npos);
  EXPECT_EQ(json_of(make({"a"}, "newmtl a\nmap_Kd maps/skin.png\n", Images::kNone).glb)
                .contains("images"),
            false);
}

TEST_F(MaterialAssetTest, AlphaIsThatOfTheBaseImage) {
  write("skin.png", kPng);
  write("holes.png", kPng);
  const Json root = json_of(make({"a", "b", "c"},
                                 "newmtl a\nmap_Kd skin.png\nmap_d skin.png\n"
                                 "newmtl b\nmap_Kd skin.png\nmap_d holes.png\n"
                                 "newmtl c\nKd 1 1 1\nmap_d holes.png\n")
                                .glb);
  EXPECT_EQ(root["materials"][0]["alphaMode"], "BLEND");
  EXPECT_FALSE(root["materials"][1].contains("alphaMode"));
  EXPECT_FALSE(root["materials"][2].contains("alphaMode"));
}

TEST_F(MaterialAssetTest, OptionsOfImagesBecomeATransform) {
  write("maps/my skin.png", kPng);
  const Json root = json_of(make({"a", "b"},
                                 "newmtl a\nmap_Kd -s 2 4 1 -o 0.5 0.25 maps/my skin.png\n"
                                 "newmtl b\nmap_Kd maps/my skin.png\n")
                                .glb);
  const Json& a = root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  // (u, 1 - v) is at (2 u + 0.5, 1 - (4 v + 0.25)).
  EXPECT_EQ(a["extensions"]["KHR_texture_transform"],
            Json::parse(R"({"scale": [2.0, 4.0], "offset": [0.5, -3.25]})"));
  EXPECT_EQ(root["extensionsUsed"], Json({"KHR_texture_transform"}));
  EXPECT_EQ(root["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"],
            Json({{"index", 0}}));
  EXPECT_EQ(root["images"].size(), 1U);
}

TEST_F(MaterialAssetTest, ImagesThatCannotBeCarriedAreNamed) {
  write("skin.tga", "TRUEVISION");
  write("large.png", kPng + std::string(100, 'x'));
  const auto note_on = [&](const std::string& name) {
    const auto made = make({"a"}, "newmtl a\nmap_Kd " + name + "\n", Images::kExact, 50);
    EXPECT_TRUE(made.files.empty());
    EXPECT_FALSE(json_of(made.glb).contains("images"));
    return made.notes.size() == 1 ? made.notes[0] : "";
  };
  EXPECT_NE(note_on("skin.tga").find("neither PNG nor JPEG"), std::string::npos);
  EXPECT_NE(note_on("../skin.png").find("not in the folder of the mesh"), std::string::npos);
  EXPECT_NE(note_on("/etc/passwd").find("not in the folder of the mesh"), std::string::npos);
  EXPECT_NE(note_on("missing.png"), "");
  EXPECT_NE(note_on("large.png"), "");
}

}  // namespace
}  // namespace rlpc
