#include "encoder/meshes/texels.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "encoder/meshes/glb_asset.h"

namespace rlpc {
namespace {

using Texels = std::vector<double>;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

std::string big_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i));
  return text;
}

std::string png(std::uint32_t width, std::uint32_t height) {
  return "\x89PNG\r\n\x1A\n" + big_endian(13, 4) + "IHDR" + big_endian(width, 4) +
         big_endian(height, 4) + std::string(5, '\0');
}

// Returns a JPEG file with an APP0 segment and a Huffman table before the frame header.
std::string jpeg(std::uint32_t width, std::uint32_t height) {
  return "\xFF\xD8\xFF\xE0" + big_endian(6, 2) + "JFIF" + "\xFF\xC4" + big_endian(4, 2) + "ab" +
         "\xFF\xC2" + big_endian(11, 2) + "\x08" + big_endian(height, 2) +
         big_endian(width, 2) + "\x01...";
}

class TexelsOfUv : public testing::Test {
 protected:
  void add(const std::string& image) {
    asset_.root["images"].push_back({{"bufferView", asset_.add_view(image)}});
    asset_.root["textures"].push_back({{"source", asset_.root["images"].size() - 1}});
  }
  nlohmann::json& material() { return asset_.root["materials"].emplace_back(); }
  std::vector<double> texels() {
    std::vector<double> all;
    for (const UvUse& use : uses_of_uv(asset_.glb({{"version", "2.0"}}), SIZE_MAX)) {
      all.push_back(use.texels);
    }
    return all;
  }

  GlbAsset asset_;
};

TEST_F(TexelsOfUv, AreThoseOfTheLargestImageThatASetAddresses) {
  add(png(64, 32));
  add(jpeg(100, 2048));
  material()["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  material()["occlusionTexture"] = {{"index", 0}, {"texCoord", 2}};
  material()["extensions"]["KHR_materials_sheen"]["sheenColorTexture"] = {{"index", 1},
                                                                          {"texCoord", 2}};
  EXPECT_EQ(texels(), (Texels{64.0, 0.0, 2048.0}));
}

TEST_F(TexelsOfUv, FollowTransformsOfTextures) {
  add(png(64, 64));
  nlohmann::json& info = material()["normalTexture"] = {{"index", 0}, {"texCoord", 3}};
  info["extensions"]["KHR_texture_transform"] = {{"texCoord", 1}, {"scale", {0.5, -4}}};
  EXPECT_EQ(texels(), (Texels{0.0, 256.0}));
}

TEST_F(TexelsOfUv, AreUnknownForOtherImages) {
  add("RIFF....WEBPVP8 ");
  add(png(64, 64).substr(0, 20));
  add(jpeg(64, 64).substr(0, 14));
  add(png(64, 64));
  asset_.root["textures"][3]["extensions"]["KHR_texture_basisu"]["source"] = 0;
  asset_.root["textures"].push_back({{"source", 77}});
  asset_.root["textures"].push_back({{"source", -1}});
  for (unsigned i = 0; i < 6; ++i) {
    material()["emissiveTexture"] = {{"index", i}, {"texCoord", i}};
  }
  EXPECT_EQ(texels(), Texels(6, kUnknown));
}

TEST_F(TexelsOfUv, AreNoneWithoutMaterials) {
  EXPECT_EQ(texels(), Texels{});
  EXPECT_TRUE(uses_of_uv("", SIZE_MAX).empty());
  EXPECT_TRUE(uses_of_uv("glTF, but not really one, and no JSON in it", SIZE_MAX).empty());
  material()["normalTexture"] = {{"index", 0}, {"texCoord", 4000000000U}};
  EXPECT_EQ(texels(), Texels{});
}

}  // namespace
}  // namespace rlpc
