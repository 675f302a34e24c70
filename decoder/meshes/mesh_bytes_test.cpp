#include "decoder/meshes/mesh_bytes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <random>

#include "decoder/meshes/obj_materials.h"

namespace rlpc {
namespace {

// A square in the plane z = 0, with one set of each kind.
SinkOptions square() {
  SinkOptions options;
  options.num_vertices = 4;
  options.num_frames = 1;
  options.triangles = {{0, 1, 2}, {0, 2, 3}};
  AttributeSet uv;
  uv.header.name = "uv0";
  uv.header.domain = AttributeDomain::kCorner;
  uv.header.num_components = 2;
  uv.header.scale = ValueScale::kGrid;
  uv.header.log2_step = -2;
  uv.values = {0, 0, 4, 0, 4, 4, 1, 1, 0, 4};
  uv.value_of_corner = {0, 1, 2, 3, 2, 4};
  AttributeSet normal;
  normal.header.name = "normal";
  normal.header.kind = ValueKind::kSmoothing;
  normal.header.num_components = 0;
  normal.face_of_triangle = {0, 1};
  AttributeSet colour;
  colour.header.name = "colour0";
  colour.header.num_components = 3;
  colour.header.value_bits = 12;
  colour.header.scale = ValueScale::kNormalised;
  colour.values = {0, 4095, 2060, 0, 0, 0, 0, 0, 0, 4095, 0, 0};
  AttributeSet material;
  material.header.name = "material";
  material.header.domain = AttributeDomain::kTriangle;
  material.values = {3, 1};
  AttributeSet part = material;
  part.header.name = "part";
  part.values = {0, 0};
  options.attributes = {uv, normal, colour, material, part};
  return options;
}
const std::vector<std::int32_t> kPositions{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

TEST(MeshBytes, ObjFilesHoldAttributes) {
  const SinkOptions options = square();
  EXPECT_EQ(make_mesh_bytes(SinkFormat::kObj, options, "a.mtl")->frame(kPositions),
            "# frame_rate 30/1\nmtllib a.mtl\nvt 0 1\nvt 1 1\nvt 1 0\nvt 0.25 0.75\nvt 0 0\n"
            "v 0 0 0 0 1 0.7374\nv 1 0 0 0 0 0\nv 1 1 0 0 0 0\nv 0 1 0 1 0 0\n"
            "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n"
            "g part_0\nusemtl material_1\nf 1/4/1 3/3/3 4/5/4\n"
            "usemtl material_3\nf 1/1/1 2/2/2 3/3/3\n");
  const auto files = ObjMaterials(options).files("a");
  ASSERT_EQ(files.size(), 1U);
  EXPECT_EQ(files[0].name, "a.mtl");
  EXPECT_EQ(files[0].bytes,
            "# materials of rlpcdec\nnewmtl material_1\nKd 0.8 0.8 0.8\n"
            "newmtl material_3\nKd 0.8 0.8 0.8\n");
}

TEST(MeshBytes, ObjFilesNameEachPartOnce) {
  SinkOptions options = square();
  options.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 2, 3}, {0, 1, 3}};
  options.attributes = {options.attributes[3], options.attributes[4]};
  options.attributes[0].values = {1, 0, 1, 1};
  options.attributes[1].values = {1, 0, 0, 1};
  const std::string obj = make_mesh_bytes(SinkFormat::kObj, options, "")->frame(kPositions);
  EXPECT_EQ(obj.substr(obj.find("g ")),
            "g part_0\nusemtl material_0\nf 1 3 4\nusemtl material_1\nf 2 3 4\n"
            "g part_1\nf 1 2 3\nf 1 2 4\n");
}

TEST(MeshBytes, PlyFilesSplitVertices) {
  SinkOptions options = square();
  options.ascii = true;
  EXPECT_EQ(make_mesh_bytes(SinkFormat::kPly, options, "")->frame(kPositions),
            "ply\nformat ascii 1.0\ncomment frame_rate 30/1\nelement vertex 5\n"
            "property float x\nproperty float y\nproperty float z\n"
            "property float nx\nproperty float ny\nproperty float nz\n"
            "property float s\nproperty float t\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\n"
            "element face 2\nproperty list uchar uint vertex_indices\nend_header\n"
            "0 0 0 0 0 1 0 1 0 255 188\n0 0 0 0 0 1 0.25 0.75 0 255 188\n"
            "1 0 0 0 0 1 1 1 0 0 0\n1 1 0 0 0 1 1 0 0 0 0\n0 1 0 0 0 1 0 0 255 0 0\n"
            "3 0 2 3\n3 1 3 4\n");
  options.ascii = false;
  const std::string bytes = make_mesh_bytes(SinkFormat::kPly, options, "")->frame(kPositions);
  EXPECT_EQ(bytes.size() - bytes.find("end_header\n") - 11, 5U * (8 * 4 + 3) + 2 * 13);
}

TEST(MeshBytes, WhatFilesCannotHoldIsTold) {
  SinkOptions options = square();
  const auto told = [&](SinkFormat format) {
    return left_out_remark(format, options, *make_mesh_bytes(format, options, ""));
  };
  EXPECT_TRUE(told(SinkFormat::kObj).empty());
  ASSERT_EQ(told(SinkFormat::kPly).size(), 1U);
  EXPECT_TRUE(told(SinkFormat::kPly)[0].starts_with("left out: material, part (PLY holds"));
  options.attributes[0].header.name = "uv1";
  options.attributes[2].header.domain = AttributeDomain::kCorner;
  options.attributes[2].value_of_corner = {0, 1, 2, 0, 2, 3};
  ASSERT_EQ(told(SinkFormat::kObj).size(), 1U);
  EXPECT_TRUE(told(SinkFormat::kObj)[0].starts_with("left out: uv1, colour0 (OBJ holds"));
}

TEST(MeshBytes, NormalsFollowTheFrame) {
  SinkOptions options = square();
  options.attributes = {options.attributes[1]};
  const auto mesh = make_mesh_bytes(SinkFormat::kObj, options, "");
  EXPECT_NE(mesh->frame(kPositions).find("vn 0 0 1\n"), std::string::npos);
  const std::string turned =
      mesh->frame(std::vector<std::int32_t>{0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1});
  EXPECT_NE(turned.find("vn 1 0 0\nvn 1 0 0\n"), std::string::npos) << turned;
  EXPECT_NE(turned.find("f 1//1 2//2 3//3\n"), std::string::npos) << turned;
}

TEST(MeshBytes, SetsOfOtherShapesAreLeftOut) {
  SinkOptions options = square();
  const SinkOptions plain{.num_vertices = 4,
                          .num_frames = 1,
                          .frame_rate = {},
                          .grid = {},
                          .triangles = options.triangles};
  options.attributes[0].header.num_components = 1;
  options.attributes[1].header.kind = ValueKind::kIntegers;
  options.attributes[1].header.num_components = 2;
  options.attributes[2].header.num_components = 2;
  options.attributes[3].header.domain = AttributeDomain::kVertex;
  options.attributes[4].header.kind = ValueKind::kFloats;
  for (const SinkFormat format : {SinkFormat::kObj, SinkFormat::kPly}) {
    EXPECT_EQ(make_mesh_bytes(format, options, "")->frame(kPositions),
              make_mesh_bytes(format, plain, "")->frame(kPositions));
  }
  EXPECT_TRUE(ObjMaterials(options).files("a").empty());
  EXPECT_EQ(MeshAttributes(square()).uv_numbers().size(), 10U);
}

// Numbers with up to six digits in an OBJ file read back exactly, although readers flip v.
TEST(MeshBytes, TextureCoordinatesReadBackAsTheyWere) {
  std::mt19937 random(1);
  SinkOptions options = square();
  options.attributes = {options.attributes[0]};
  options.attributes[0].header.kind = ValueKind::kFloats;
  for (int i = 0; i < 2000; ++i) {
    std::string text = std::to_string(random() % 1000000);
    text = "0." + std::string(6 - text.size(), '0') + text;
    text.erase(text.find_last_not_of('0') + 1);
    if (text == "0.") text = "0";
    const float v = std::stof(text);
    options.attributes[0].values.assign(10, std::bit_cast<std::uint32_t>(1.0F - v));
    const std::string obj = make_mesh_bytes(SinkFormat::kObj, options, "")->frame(kPositions);
    const std::size_t at = obj.find(' ', obj.find("vt ") + 3) + 1;
    const std::string found = obj.substr(at, obj.find('\n', at) - at);
    EXPECT_EQ(std::stof(found), v) << text << " " << found;
    EXPECT_LE(found.size(), std::max<std::size_t>(text.size(), 5)) << text << " " << found;
  }
}

// Exact colours have seven digits, others four.
TEST(MeshBytes, ExactColoursHaveAllDigits) {
  SinkOptions options = square();
  options.attributes = {options.attributes[2]};
  AttributeSet& colour = options.attributes[0];
  colour.header.kind = ValueKind::kFloats;
  colour.header.scale = ValueScale::kNone;
  colour.values.assign(12, std::bit_cast<std::uint32_t>(0.2015F));
  const std::string obj = make_mesh_bytes(SinkFormat::kObj, options, "")->frame(kPositions);
  EXPECT_NE(obj.find("v 0 0 0 0.486211"), std::string::npos) << obj;
}

TEST(MeshBytes, NumbersThatAreNotFiniteBecomeZero) {
  SinkOptions options = square();
  options.attributes = {options.attributes[0]};
  options.attributes[0].header.kind = ValueKind::kFloats;
  options.attributes[0].values.assign(10, 0x7FC00000);  // not a number
  EXPECT_NE(make_mesh_bytes(SinkFormat::kObj, options, "")->frame(kPositions).find("vt 0 0\n"),
            std::string::npos);
}

}  // namespace
}  // namespace rlpc
