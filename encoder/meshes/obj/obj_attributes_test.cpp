#include "encoder/meshes/obj/obj_attributes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "encoder/meshes/materials/material_files.h"
#include "encoder/meshes/obj/obj_reader.h"
#include "encoder/testing/obj_errors.h"

namespace rlpc {
namespace {

// Two triangles, one of which is in the plane z = 0.
const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

SingleMesh mesh_of(const std::string& text) {
  auto mesh = parse_obj(text, "a.obj");
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? std::move(*mesh) : SingleMesh{};
}

const SourceAttribute* find(const SingleMesh& mesh, const std::string& name) {
  for (const SourceAttribute& set : mesh.attributes.sets) {
    if (set.name == name) return &set;
  }
  return nullptr;
}

std::vector<float> at_corner(const SourceAttribute& set, std::size_t corner) {
  const std::size_t n = set.num_components;
  const auto first =
      set.values.begin() + static_cast<std::ptrdiff_t>(n * set.value_of_corner[corner]);
  return {first, first + static_cast<std::ptrdiff_t>(n)};
}

using Floats = std::vector<float>;

TEST(ObjAttributes, MeshesWithoutHaveNone) {
  const SingleMesh mesh = mesh_of(kVertices + "o a\ng b\nusemtl c\nf 1 2 3\nf 1 2 4\n");
  EXPECT_TRUE(mesh.attributes.sets.empty());
  EXPECT_EQ(mesh.materials.names, std::vector<std::string>{"c"});
  EXPECT_EQ(mesh.materials.part_names, std::vector<std::string>{"a/b"});
  EXPECT_TRUE(mesh_of(kVertices + "f 1 2 3\n").materials.part_names.empty());
}

TEST(ObjAttributes, TextureCoordinatesPointDown) {
  const SingleMesh mesh =
      mesh_of(kVertices + "vt 0.25 0\nvt 0.5 0.75\nvt 1\nf 1/1 2/2 3/3\nf 1/-3 2/2 4/-1\n");
  ASSERT_EQ(mesh.attributes.sets.size(), 1U);
  const SourceAttribute& uv = mesh.attributes.sets[0];
  EXPECT_EQ(uv.name, "uv0");
  EXPECT_EQ(uv.domain, AttributeDomain::kCorner);
  EXPECT_EQ(uv.values, (Floats{0.25F, 1, 0.5F, 0.25F, 1, 1}));
  EXPECT_EQ(uv.value_of_corner, (std::vector<std::uint32_t>{0, 1, 2, 0, 1, 2}));
}

TEST(ObjAttributes, NegativeIndicesCountTheirOwnList) {
  const SingleMesh mesh = mesh_of(kVertices + "vt 0 1\nvt 1 1\nvn 1 0 0\nvn 0 1 0\nvn 0 0 1\n" +
                                  "f -4/-2/-3 -3/-1/-2 -2/-1/-1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  const SourceAttribute& normal = *find(mesh, "normal");
  EXPECT_EQ(at_corner(normal, 0), (Floats{1, 0, 0}));
  EXPECT_EQ(at_corner(normal, 2), (Floats{0, 0, 1}));
  const SourceAttribute& uv = *find(mesh, "uv0");
  EXPECT_EQ(at_corner(uv, 0), (Floats{0, 0}));
  EXPECT_EQ(at_corner(uv, 2), (Floats{1, 0}));
}

TEST(ObjAttributes, FansKeepTheValuesOfTheirCorners) {
  const SingleMesh mesh = mesh_of(
      kVertices + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 2\nf 1/4/1 2/3/1 3/2/1 4/1/1\n");
  EXPECT_EQ(find(mesh, "uv0")->value_of_corner, (std::vector<std::uint32_t>{3, 2, 1, 3, 1, 0}));
  EXPECT_EQ(find(mesh, "normal")->values, (Floats{0, 0, 1}));
  EXPECT_EQ(find(mesh, "normal")->kind, SourceAttribute::Kind::kNormals);
}

TEST(ObjAttributes, MissingCornersGetUsualValues) {
  const SingleMesh mesh = mesh_of(kVertices +
                                  "f 1 2 3\nvt 0.5 0.5\nvn 1 0 0\nvn 0 0 0\n"
                                  "f 1/1/1 2//2 4\n");
  const SourceAttribute& uv = *find(mesh, "uv0");
  EXPECT_EQ(at_corner(uv, 0), (Floats{0, 1}));
  EXPECT_EQ(at_corner(uv, 3), (Floats{0.5F, 0.5F}));
  EXPECT_EQ(at_corner(uv, 5), (Floats{0, 1}));
  const SourceAttribute& normal = *find(mesh, "normal");
  EXPECT_EQ(at_corner(normal, 1), (Floats{0, 0, 1}));
  EXPECT_EQ(at_corner(normal, 3), (Floats{1, 0, 0}));
  EXPECT_EQ(at_corner(normal, 4), (Floats{0, -1, 0}));  // its length was 0
  EXPECT_EQ(at_corner(normal, 5), (Floats{0, -1, 0}));
}

TEST(ObjAttributes, IndicesOutOfRangeAreNamed) {
  expect_obj_error(kVertices + "vt 0 0\nf 1/1 2/2 3/1\n",
                   "a.obj:6: texture coordinate index 2 is out of range 1 to 1");
  const SingleMesh none = mesh_of(kVertices + "f 1/1/1 2/1/2 3/1/2\n");
  EXPECT_TRUE(none.attributes.sets.empty());
  EXPECT_EQ(none.notes,
            (std::vector<std::string>{
                "ignores each texture coordinate index, as the file has none of these",
                "ignores each normal index, as the file has none of these"}));
  expect_obj_error(kVertices + "vn 0 0 1\nf 1//1 2//0 3//1\n", "a.obj:6: normal index 0;");
  expect_obj_error(kVertices + "vn 0 0 1\nf 1//1 2//-2 3//1\n",
                   "a.obj:6: normal index -2, but only 1 come before it");
  expect_obj_error(kVertices + "vt 0 nan\n", "a.obj:5:");
  expect_obj_error(kVertices + "vn 0 0\n", "a.obj:5: a normal needs three coordinates");
  MeshLimit positions_only;
  positions_only.with_attributes = false;
  const auto mesh = parse_obj(kVertices + "vt x\nf 1/9 2//0 3/1/1\n", "a.obj", positions_only);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_TRUE(mesh->attributes.sets.empty());
}

TEST(ObjAttributes, WhatIsNoFaceIsTold) {
  EXPECT_EQ(mesh_of(kVertices + "l 1 2 3\np 1\nf 1 2 3\n").notes,
            std::vector<std::string>{"dropped: lines (1), points (1)"});
}

TEST(ObjAttributes, ValuesMayFollowTheFaces) {
  const SingleMesh mesh = mesh_of(kVertices + "f 1/1 2/2 3/2\nvt 0 0\nvt 1 1\n");
  EXPECT_EQ(find(mesh, "uv0")->value_of_corner, (std::vector<std::uint32_t>{0, 1, 1}));
}

TEST(ObjAttributes, ColoursBecomeLinear) {
  const std::string text = "v 0 0 0 1 0 0.5\nv 1 0 0\nv 0 1 0 0.04 1 1\n";
  const SingleMesh mesh = mesh_of(text + "f 1 2 3\n");
  const SourceAttribute& colour = *find(mesh, "colour0");
  EXPECT_EQ(colour.domain, AttributeDomain::kVertex);
  ASSERT_EQ(colour.values.size(), 9U);
  EXPECT_NEAR(colour.values[2], 0.2140411, 1e-6);
  EXPECT_NEAR(colour.values[6], 0.04 / 12.92, 1e-6);
  EXPECT_EQ(Floats(colour.values.begin() + 3, colour.values.begin() + 6), (Floats{1, 1, 1}));
  const SingleMesh other = mesh_of(text + "v 1 1 1 0 -2 7\nf 1 2 3\n");
  EXPECT_EQ(find(other, "colour0"), nullptr);
  ASSERT_EQ(other.notes.size(), 1U);
  EXPECT_NE(other.notes[0].find("no colours"), std::string::npos);
}

TEST(ObjAttributes, MaterialsAndPartsAreNumberedAsTheyAppear) {
  const SingleMesh mesh = mesh_of(kVertices +
                                  "f 1 2 3\nusemtl shiny red\no b\nf 1 2 3 4\ng c d\n"
                                  "usemtl dull\nf 1 2 4\nusemtl shiny red\no b\ng\nf 1 2 4\n");
  EXPECT_EQ(find(mesh, "material")->values, (Floats{2, 0, 0, 1, 0}));
  EXPECT_EQ(find(mesh, "part")->values, (Floats{0, 1, 1, 2, 1}));
  EXPECT_EQ(mesh.materials.names, (std::vector<std::string>{"shiny red", "dull"}));
  EXPECT_EQ(mesh.materials.part_names, (std::vector<std::string>{"", "b", "b/c d"}));
}

TEST(ObjAttributes, GroupsOfOneMaterialAreParts) {
  const SingleMesh mesh =
      mesh_of(kVertices + "usemtl m\ng a\nf 1 2 3\ng b\nf 1 2 4\ng a\nf 1 3 4\n");
  EXPECT_EQ(find(mesh, "material"), nullptr);
  EXPECT_EQ(find(mesh, "part")->values, (Floats{0, 1, 0}));
  EXPECT_EQ(mesh.materials.part_names, (std::vector<std::string>{"a", "b"}));
}

TEST(ObjAttributes, MemoryHasALimit) {
  const std::string text = kVertices + "vt 0 0\nvt 1 1\nvn 0 0 1\no a\nf 1/1 2/2 3/1\n" +
                           "usemtl b\nusemtl c\nf 1/1/1 2/2/1 3/1/1 4/2/1\n";
  MeshLimit limit{1 << 20, 0};
  while (!parse_obj(text, "a", limit)) ++limit.mesh_bytes;
  EXPECT_GE(limit.mesh_bytes, mesh_of(text).memory_bytes());
  EXPECT_LE(limit.mesh_bytes, 3000U);
}

TEST(MaterialFiles, TexturesAreListedOnce) {
  EXPECT_EQ(textures_of("newmtl a\nmap_Kd -s 1 1 1 skin.png\nKd 1 1 1\nbump b.png\n"
                        "map_Ks skin.png\n"),
            (std::vector<std::string>{"skin.png", "b.png"}));
}

// Gaps are filled and reported.
TEST(ObjAttributes, TellsWhereValuesAreMissing) {
  const SingleMesh some =
      mesh_of("v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 1 0\nvt 0 1\nf 1/1 2/1 3\n");
  EXPECT_EQ(some.notes, (std::vector<std::string>{
                            "1 of 3 vertices have no colour: they become white",
                            "1 of 3 corners have no texture coordinates: they get 0 0"}));
}

}  // namespace
}  // namespace rlpc
