#include "encoder/meshes/obj/obj_reader.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "encoder/meshes/off/off_reader.h"
#include "encoder/meshes/ply/ply_reader.h"
#include "encoder/testing/obj_errors.h"

namespace rlpc {
namespace {

const std::string kThreeVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

std::vector<Triangle> triangles_of(const std::string& text) {
  const auto mesh = parse_obj(text, "a.obj");
  EXPECT_TRUE(mesh) << mesh.error().message;
  return mesh ? mesh->triangles : std::vector<Triangle>{};
}

TEST(ObjReader, ReadsOneTriangle) {
  const auto mesh = parse_obj(kThreeVertices + "f 1 2 3\n", "a.obj");
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->xyz, (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(mesh->triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_FALSE(mesh->frame_rate);
}

TEST(ObjReader, AcceptsEveryFormOfCorner) {
  const std::string others = "vt 0 0\nvt 1\nvt 0 1 0\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\n";
  EXPECT_EQ(triangles_of(kThreeVertices + others + "f 1/1 2//2 3/3/3\nf -3/-1/-1 -2//-1 -1\n"),
            (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}));
}

TEST(ObjReader, SplitsConvexPolygonsIntoAFan) {
  EXPECT_EQ(triangles_of("v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nf 5 4 3 2 1\n"),
            (std::vector<Triangle>{{4, 3, 2}, {4, 2, 1}, {4, 1, 0}}));
}

TEST(ObjReader, AcceptsZeroFaces) { EXPECT_TRUE(triangles_of(kThreeVertices).empty()); }

TEST(ObjReader, AcceptsFacesBeforeTheirVertices) {
  EXPECT_EQ(triangles_of("f 1 2 3\n" + kThreeVertices), (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(ObjReader, IgnoresOtherKeywords) {
  const auto mesh = parse_obj(
      "\xEF\xBB\xBFmtllib a.mtl\r\n\r\n# a comment\r\no thing\r\n"
      "v 0 0 0 1 # with w\r\nv\t1 0 0 0.5 0.5 0.5\r\n  v +0 1e0 -.5\r\nvn 0 0 1\r\nvt 0 0\r\n"
      "usemtl m\r\ns off\r\nf 1 2 3 # corners\r\n",
      "a.obj");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->xyz, (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, -0.5F}));
  EXPECT_EQ(mesh->triangles.size(), 1U);
  EXPECT_EQ(mesh->material_library, "a.mtl");
}

TEST(ObjReader, JoinsContinuedLines) {
  EXPECT_EQ(triangles_of("v 0 0 \\\n0\nv 1 0 0\r\nv 0 1 0\nf 1 \\\r\n 2\\\n 3"),
            (std::vector<Triangle>{{0, 1, 2}}));
  expect_obj_error("v 0 0 \\\n0\nv 1 0 x\n",
                   "a.obj:3: \"x\"");  // a joined line counts as two lines
}

TEST(ObjReader, AcceptsCarriageReturnsAsLineEnds) {
  EXPECT_EQ(triangles_of("v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r").size(), 1U);
  expect_obj_error("v 0 0 0\rv 1 0\r", "a.obj:2: a vertex needs three coordinates");
}

TEST(ObjReader, RoundsNumbersCorrectly) {
  // Just below and above the midpoint of two floats: rounding to double first would be wrong.
  const auto mesh = parse_obj(
      "v 1.00000017881393432617187499 1.00000017881393432617187501 1e30\n"
      "v 1e-50 -1e-400 1.4e-45\n",
      "a.obj");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->xyz[0], 0x1.000002p0F);
  EXPECT_EQ(mesh->xyz[1], 0x1.000004p0F);
  EXPECT_EQ(mesh->xyz[2], 1e30F);
  EXPECT_EQ(mesh->xyz[3], 0.0F);
  EXPECT_EQ(mesh->xyz[4], 0.0F);
  EXPECT_EQ(mesh->xyz[5], std::numeric_limits<float>::denorm_min());
}

TEST(ObjReader, KeepsWhatFloatsLeaveOfNumbers) {
  const auto mesh = parse_obj("v 0.1 0.5 -0.3\n", "a.obj");
  ASSERT_TRUE(mesh) << mesh.error().message;
  const auto left_of = [](double x) { return x - static_cast<double>(static_cast<float>(x)); };
  EXPECT_EQ(mesh->left, (std::vector<double>{left_of(0.1), 0, left_of(-0.3)}));
}

TEST(ObjReader, RefusesNonFiniteNumbers) {
  expect_obj_error("v 0 0 0\nv 0 nan 0\n", "a.obj:2: \"nan\" is not finite");
  expect_obj_error("v inf 0 0\n", "a.obj:1: \"inf\" is not finite");
  expect_obj_error("v 0 -infinity 0\n", "a.obj:1: \"-infinity\" is not finite");
  expect_obj_error("v 0 0 1e39\n", "a.obj:1: \"1e39\" is too large");
  expect_obj_error("v 0 0 -1e400\n", "a.obj:1: \"-1e400\" is too large");
}

TEST(ObjReader, RefusesInvalidNumbers) {
  expect_obj_error("v 0 0 abc\n", "a.obj:1: \"abc\" is not a number");
  expect_obj_error("v 0 0 0x10\n", "\"0x10\" is not a number");
  expect_obj_error("v 0 0 1.5.2\n", "\"1.5.2\" is not a number");
  expect_obj_error("v 0 0 +\n", "\"+\" is not a number");
  expect_obj_error("v 0 0 1,5\n", "\"1,5\" is not a number");
  expect_obj_error("\n\nv 0 0\n", "a.obj:3: a vertex needs three coordinates");
}

TEST(ObjReader, RefusesIndicesOutOfRange) {
  expect_obj_error(kThreeVertices + "f 1 2 9\n",
                   "a.obj:4: vertex index 9 is out of range 1 to 3");
  expect_obj_error(kThreeVertices + "f 1 2 9\nf 1 2 7\n", "a.obj:4: vertex index 9");
  expect_obj_error(kThreeVertices + "f 0 1 2\n", "a.obj:4: vertex index 0");
  expect_obj_error(kThreeVertices + "f 1 2 -4\n", "a.obj:4: vertex index -4, but only 3");
  expect_obj_error(kThreeVertices + "f 1 2 4294967296\n", "a.obj:4: vertex index 4294967296");
  expect_obj_error(kThreeVertices + "f 1 2 99999999999999999999\n", "is not a face corner");
}

TEST(ObjReader, RefusesBrokenFaces) {
  expect_obj_error(kThreeVertices + "f 1 2\n", "a.obj:4: a face of 2 corners");
  expect_obj_error(kThreeVertices + "f\n", "a.obj:4: a face of 0 corners");
  for (const char* corner : {"3/", "3//", "3/1/", "3/x", "x", "3.0", "3/1/1/1", "/1"}) {
    expect_obj_error(kThreeVertices + "f 1 2 " + corner + "\n", "is not a face corner");
  }
}

TEST(ObjReader, RefusesBinaryFiles) {
  expect_obj_error(std::string("v 0 0 0\n\0\1", 10), "a zero byte at byte 8");
  expect_obj_error(
      "\x7F"
      "ELF\x02\x01 garbage",
      "no vertex");
  expect_obj_error("# only a comment\n", "no vertex");
}

TEST(ObjReader, RefusesMissingAndEmptyFiles) {
  const auto missing = read_mesh("no_such_file.obj");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("no_such_file.obj: no such file"), std::string::npos);
  const auto folder = read_mesh(".");
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().message.find("not a regular file"), std::string::npos);
}

TEST(ObjReader, ReadsTheFrameRateThatRlpcdecWrites) {
  const auto mesh =
      parse_obj("# frame_rate 30000/1001\n# frame_rate 5/1\n" + kThreeVertices, "a");
  ASSERT_TRUE(mesh);
  ASSERT_TRUE(mesh->frame_rate);
  EXPECT_EQ(*mesh->frame_rate, (FrameRate{30000, 1001}));
  const auto other = parse_obj("# frame_rate fast\n" + kThreeVertices, "a");
  ASSERT_TRUE(other);
  EXPECT_FALSE(other->frame_rate);
}

// Every prefix of a file with all features gives a mesh or an error, never a crash.
TEST(ObjReader, SurvivesEveryPrefix) {
  const std::string text = kThreeVertices + "f 1/1 2//2 \\\n3/3/3 -1\n# end \\\nv 1 2 3 \\\r\n";
  for (std::size_t n = 0; n <= text.size(); ++n) {
    const auto mesh = parse_obj(std::string(text, 0, n), "a.obj");
    if (mesh) {
      EXPECT_EQ(mesh->xyz.size() % 3, 0U);
    }
  }
}

TEST(MeshReader, MemoryHasALimit) {
  const std::string points = kThreeVertices + kThreeVertices;
  const std::string obj = points + "f 1 2 3 4 5 6\nf 1 2 3 4 5 6\n";
  const std::string off = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n5 0 1 2 0 1\n5 0 1 2 0 1\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 2\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n5 0 1 2 0 1\n5 0 1 2 0 1\n";
  const auto min = [](const auto& parse, const std::string& text) {
    MeshLimit limit{1 << 20, 0};
    while (true) {
      const auto mesh = parse(text, "a", limit);
      if (mesh) return limit.mesh_bytes;
      EXPECT_NE(mesh.error().message.find("needs more memory than the limit of 1 MiB"),
                std::string::npos)
          << mesh.error().message;
      ++limit.mesh_bytes;
    }
  };
  // Numbers that floats cannot represent take more; to lack room for them ends the reading,
  // too.
  const std::string finer = "v 0.5 0.25 1\nv 0.1 0.2 0.3\n" + kThreeVertices + "f 1 2 3\n";
  EXPECT_GT(min(parse_obj, finer), 9 * (sizeof(float) + sizeof(double)));
  for (const std::uint64_t bytes :
       {min(parse_obj, obj), min(parse_off, off), min(parse_ply, ply)}) {
    EXPECT_GE(bytes, 9 * sizeof(float) + 6 * sizeof(Triangle));
    EXPECT_LE(bytes, 1000);
  }
}

}  // namespace
}  // namespace rlpc
