#include "encoder/meshes/ply/ply_attributes.h"

#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <vector>

#include "encoder/meshes/ply/ply_reader.h"

namespace rlpc {
namespace {

using Floats = std::vector<float>;
using Indices = std::vector<std::uint32_t>;

std::string header(const std::string& encoding, const std::string& vertex_properties,
                   const std::string& face_properties) {
  return "ply\nformat " + encoding + " 1.0\ncomment TextureFile skin.png\nelement vertex 4\n" +
         "property float x\nproperty float y\nproperty float z\n" + vertex_properties +
         "element face 1\nproperty list uchar int vertex_indices\n" + face_properties +
         "end_header\n";
}

SingleMesh mesh_of(const std::string& text) {
  auto mesh = parse_ply(text, "a.ply");
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? std::move(*mesh) : SingleMesh{};
}

// Returns a text mesh with the same numbers after the position of each vertex.
SingleMesh text_mesh(const std::string& vertex_properties, const std::string& values,
                     const std::string& face_properties = "",
                     const std::string& face_values = "") {
  std::string text = header("ascii", vertex_properties, face_properties);
  for (const char* const xyz : {"0 0 0 ", "1 0 0 ", "1 1 0 ", "0 1 0 "}) {
    text += xyz + values + "\n";
  }
  return mesh_of(text + "4 0 1 2 3 " + face_values + "\n");
}

TEST(PlyAttributes, ReadsEveryNameOfTextureCoordinates) {
  for (const auto& [u, v] : std::vector<std::pair<std::string, std::string>>{
           {"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
    const SingleMesh mesh =
        text_mesh("property float " + u + "\nproperty double " + v + "\n", "0.5 0.25");
    ASSERT_EQ(mesh.attributes.sets.size(), 1U);
    EXPECT_EQ(mesh.attributes.sets[0].name, "uv0");
    EXPECT_EQ(mesh.attributes.sets[0].domain, AttributeDomain::kVertex);
    EXPECT_EQ(mesh.attributes.sets[0].values,
              (Floats{0.5F, 0.75F, 0.5F, 0.75F, 0.5F, 0.75F, 0.5F, 0.75F}));
    EXPECT_EQ(mesh.materials.textures, std::vector<std::string>{"skin.png"});
  }
}

TEST(PlyAttributes, NormalsGetLengthOne) {
  const SingleMesh mesh =
      text_mesh("property float nx\nproperty float ny\nproperty float nz\n", "0 3 4");
  EXPECT_EQ(mesh.attributes.sets[0].name, "normal");
  EXPECT_EQ(mesh.attributes.sets[0].values.size(), 12U);
  EXPECT_FLOAT_EQ(mesh.attributes.sets[0].values[1], 0.6F);
  EXPECT_FLOAT_EQ(mesh.attributes.sets[0].values[2], 0.8F);
}

TEST(PlyAttributes, BytesOfColoursStayApart) {
  const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  std::vector<float> linear;
  for (int x = 0; x < 256; ++x) {
    const SingleMesh mesh = text_mesh(rgb, std::to_string(x) + " 0 255");
    const SourceAttribute& colour = mesh.attributes.sets[0];
    EXPECT_EQ(colour.num_components, 3U);
    EXPECT_EQ(colour.max_value, 4095U);
    EXPECT_EQ(colour.values[1], 0.0F);
    EXPECT_EQ(colour.values[2], 4095.0F);
    if (!linear.empty()) {
      EXPECT_GT(colour.values[0], linear.back());
    }
    linear.push_back(colour.values[0]);
  }
  EXPECT_EQ(linear[188], 2059.0F);  // 0.5029
}

TEST(PlyAttributes, ColoursMayBeFloatsWithOpacity) {
  const std::string rgba =
      "property float red\nproperty float green\nproperty float blue\nproperty float alpha\n";
  const SingleMesh mesh = text_mesh(rgba, "0 0.5 1 0.5");
  const SourceAttribute& colour = mesh.attributes.sets[0];
  EXPECT_EQ(colour.num_components, 4U);
  EXPECT_EQ(colour.max_value, 0U);
  EXPECT_NEAR(colour.values[1], 0.2140411, 1e-6);
  EXPECT_EQ(colour.values[3], 0.5F);
  const SingleMesh wrong = text_mesh(rgba, "0 0.5 7 0.5");
  EXPECT_TRUE(wrong.attributes.sets.empty());
  EXPECT_EQ(wrong.notes, std::vector<std::string>{"dropped: colours outside 0 to 1"});
}

TEST(PlyAttributes, ColoursMayHave16Bits) {
  const SingleMesh mesh = text_mesh(
      "property ushort red\nproperty ushort green\nproperty ushort blue\n", "0 32768 65535");
  ASSERT_EQ(mesh.attributes.sets.size(), 1U);
  const SourceAttribute& colour = mesh.attributes.sets[0];
  EXPECT_EQ(colour.max_value, 0U);
  EXPECT_NEAR(colour.values[1], 0.2140411, 1e-4);
  EXPECT_NEAR(colour.values[2], 1.0, 1e-6);
}

TEST(PlyAttributes, EachFaceHasItsColour) {
  std::string text =
      header("ascii", "", "property uchar red\nproperty uchar green\nproperty uchar blue\n");
  text.replace(text.find("face 1"), 6, "face 2");
  const SingleMesh mesh =
      mesh_of(text + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n4 0 1 2 3 0 255 0\n");
  ASSERT_EQ(mesh.attributes.sets.size(), 1U);
  const SourceAttribute& colour = mesh.attributes.sets[0];
  EXPECT_EQ(colour.values, (Floats{4095, 0, 0, 0, 4095, 0}));
  EXPECT_EQ(colour.value_of_corner, (Indices{0, 0, 0, 1, 1, 1, 1, 1, 1}));
}

TEST(PlyAttributes, FacesMayHaveTextureCoordinatesAndColours) {
  const SingleMesh mesh =
      text_mesh("property float s\nproperty float t\n", "0 0",
                "property list uchar float texcoord\nproperty uchar red\n"
                "property uchar green\nproperty uchar blue\nproperty int texnumber\n",
                "8 0 0 1 0 1 1 0 1 255 0 0 0");
  ASSERT_EQ(mesh.attributes.sets.size(), 2U);
  EXPECT_EQ(mesh.attributes.sets[0].name, "colour0");
  EXPECT_EQ(mesh.attributes.sets[0].value_of_corner, Indices(6, 0));
  EXPECT_EQ(mesh.attributes.sets[1].values, (Floats{0, 1, 1, 1, 1, 0, 0, 0}));
  EXPECT_EQ(mesh.attributes.sets[1].value_of_corner, (Indices{0, 1, 2, 0, 2, 3}));
  const std::string text = header("ascii", "", "property list uchar float texcoord\n") +
                           "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 6 0 0 1 0 1 1\n";
  const SingleMesh wrong = mesh_of(text);
  EXPECT_TRUE(wrong.attributes.sets.empty());
  EXPECT_EQ(wrong.notes, std::vector<std::string>{
                             "dropped: lists texcoord without two values for each corner"});
}

TEST(PlyAttributes, ColoursOfFacesBesideThoseOfVerticesAreTold) {
  const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const SingleMesh mesh = text_mesh(rgb, "255 255 255", rgb, "255 0 0");
  ASSERT_EQ(mesh.attributes.sets.size(), 1U);
  EXPECT_EQ(mesh.attributes.sets[0].domain, AttributeDomain::kVertex);
  EXPECT_EQ(mesh.notes,
            std::vector<std::string>{"dropped: \"red\", \"green\", \"blue\" of faces"});
}

TEST(PlyAttributes, FacesMayHaveMaterials) {
  std::string text = header("ascii", "", "property int material_index\n");
  text.replace(text.find("face 1"), 6, "face 2");
  text += "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 5\n";
  const SingleMesh mesh = mesh_of(text + "3 0 2 3 1\n");
  EXPECT_EQ(mesh.attributes.sets[0].name, "material");
  EXPECT_EQ(mesh.attributes.sets[0].values, (Floats{5, 5, 1}));
  EXPECT_TRUE(mesh_of(text + "3 0 2 3 5\n").attributes.sets.empty());
  EXPECT_EQ(mesh_of(text + "3 0 2 3 65535\n").attributes.sets[0].values, (Floats{5, 5, 65535}));
  for (const char* const number : {"-1", "65536"}) {
    const SingleMesh wrong = mesh_of(text + "3 0 2 3 " + number + "\n");
    EXPECT_TRUE(wrong.attributes.sets.empty()) << number;
    EXPECT_EQ(wrong.notes.size(), 1U) << number;
  }
}

TEST(PlyAttributes, ReadsBinaryFiles) {
  std::string bytes = header("binary_little_endian", "property float s\nproperty float t\n",
                             "property list uchar float texcoord\n");
  const auto put = [&](float x) {
    for (int i = 0; i < 4; ++i)
      bytes += static_cast<char>(std::bit_cast<std::uint32_t>(x) >> 8 * i);
  };
  for (int i = 0; i < 20; ++i) put(0.5F);
  bytes += std::string("\x04\0\0\0\0\1\0\0\0\2\0\0\0\3\0\0\0\x08", 18);
  for (int i = 0; i < 8; ++i) put(0.25F);
  EXPECT_EQ(mesh_of(bytes).attributes.sets[0].values[1], 0.75F);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    EXPECT_FALSE(parse_ply(bytes.substr(0, n), "a.ply")) << n;
  }
  MeshLimit limit{1 << 20, 0};
  while (!parse_ply(bytes, "a", limit)) ++limit.mesh_bytes;
  EXPECT_GE(limit.mesh_bytes, mesh_of(bytes).memory_bytes());
  EXPECT_LE(limit.mesh_bytes, 1000U);
}

}  // namespace
}  // namespace rlpc
