#include "decoder/meshes/gltf/glb_buffers.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

GltfJson last_accessor(const GlbBuffers& buffers) { return buffers.accessors().back(); }

TEST(GlbBuffers, MakesByteVectorsSparseWhereThatIsSmaller) {
  GlbBuffers buffers;
  std::vector<std::int8_t> xyz(3 * 300);
  for (std::size_t v = 0; v < 100; ++v) xyz[3 * v + 1] = static_cast<std::int8_t>(v + 1);
  buffers.add_byte_vectors(xyz, true);
  const GltfJson few = last_accessor(buffers);
  EXPECT_FALSE(few.contains("bufferView"));
  EXPECT_EQ(few["sparse"]["count"], 100);
  EXPECT_EQ(few["normalized"], true);
  EXPECT_EQ(few["max"], GltfJson::array({0, 100, 0}));
  const auto view = few["sparse"]["values"]["bufferView"].get<std::size_t>();
  EXPECT_EQ(buffers.views()[view]["byteLength"], 300);  // tightly packed
  std::fill(xyz.begin(), xyz.end(), std::int8_t{1});
  buffers.add_byte_vectors(xyz, true);
  EXPECT_TRUE(last_accessor(buffers).contains("bufferView"));
}

TEST(GlbBuffers, RoundsTextureCoordinatesWithinTheImage) {
  GlbBuffers buffers;
  buffers.add_texture_coordinates(std::vector<float>{0, 1, 0.5F, 0.25F});
  EXPECT_EQ(last_accessor(buffers)["componentType"], 5123);
  EXPECT_EQ(last_accessor(buffers)["normalized"], true);
  EXPECT_EQ(buffers.views().back()["byteLength"], 8);
  buffers.add_texture_coordinates(std::vector<float>{0, 1.5F});
  EXPECT_EQ(last_accessor(buffers)["componentType"], 5126);
  buffers.add_texture_coordinates(std::vector<float>{-0.1F, 1});
  EXPECT_EQ(last_accessor(buffers)["componentType"], 5126);
}

TEST(GlbBuffers, PacksValuesOfAnimationsIntoOneView) {
  GlbBuffers buffers;
  buffers.add_times(std::vector<float>{0, 1, 2});
  buffers.add_short_values(std::vector<float>{1, -1, 0.5F}, "SCALAR");
  buffers.add_values(std::vector<float>{1, 2, 3}, "VEC3");
  ASSERT_EQ(buffers.views().size(), 1U);
  EXPECT_EQ(buffers.accessors()[1]["byteOffset"], 12);
  EXPECT_EQ(last_accessor(buffers)["byteOffset"], 20);  // after 6 bytes, at a multiple of 4
  EXPECT_EQ(buffers.views()[0]["byteLength"], 32);
  EXPECT_EQ(buffers.chunk().size(), 32U);
}

}  // namespace
}  // namespace rlpc
