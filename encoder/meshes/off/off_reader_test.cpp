#include "encoder/meshes/off/off_reader.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace rlpc {
namespace {

const std::string kQuad = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n4 0 1 2 3\n";

void expect_mesh(const std::string& text) {
  const auto mesh = parse_off(text, "a.off");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->xyz, (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5F}));
  EXPECT_EQ(mesh->triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

void expect_error(const std::string& text, const std::string& part) {
  const auto mesh = parse_off(text, "a.off");
  ASSERT_FALSE(mesh) << part;
  EXPECT_NE(mesh.error().message.find(part), std::string::npos) << part << "\n"
                                                                << mesh.error().message;
}

TEST(OffReader, ReadsPolygons) { expect_mesh(kQuad); }

TEST(OffReader, SkipsCommentsBlankLinesAndColours) {
  expect_mesh(
      "# by hand\r\n\r\nCOFF 4 1 # counts\r\n\r\n0 0 0 1 0 0 1\r\n1 0 0 1 0 0 1\r\n# next\r\n"
      "1 1 0 1 0 0 1\r\n0 1 .5 1 0 0 1\r\n\r\n4 0 1 2 3 255 0 0\r\n# end\r\n");
}

TEST(OffReader, SkipsTextureCoordinates) {
  expect_mesh("STOFF\n4 1 0\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 .5 0 1\n4 0 1 2 3\n");
}

TEST(OffReader, EveryProperPrefixFails) {
  for (std::size_t n = 0; n + 1 < kQuad.size(); ++n) {
    const std::vector<char> exact(kQuad.begin(),
                                  kQuad.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_FALSE(parse_off(std::string_view(exact.data(), n), "a.off")) << n;
  }
}

TEST(OffReader, NamesTheLineOfABadValue) {
  expect_error("OFF\n1 0 0\n0 nan 0\n", "a.off:3: \"nan\" is not finite");
  expect_error("OFF\n2 0 0\n0 0\n1 1 1\n", "a.off:3: a vertex needs three coordinates");
  expect_error("OFF\n1 1 0\n0 0 0\n3 0 0 1\n",
               "a.off:4: vertex index 1 is out of range 0 to 0");
  expect_error("OFF\n1 1 0\n0 0 0\n3 0 0 -1\n", "a.off:4: \"-1\": expected a vertex index");
  expect_error("OFF\n1 1 0\n0 0 0\n2 0 0 0\n", "a.off:4: a face of 2 corners");
  expect_error(kQuad + "3 0 1 2\n", "a.off:8: has data after the last face");
}

TEST(OffReader, RefusesCountsThatDoNotFitTheFile) {
  expect_error("OFF\n4294967295 1 0\n0 0 0\n",
               "a.off:2: 4294967295 vertices and 1 faces do not");
  expect_error("OFF\n4294967296 1 0\n0 0 0\n",
               "\"4294967296\": expected the number of vertices");
  expect_error("OFF\n1 1 0\n0 0 0\n4000000000 0 0 0\n", "expected a vertex index");
  std::string shorter = "OFF\n11 0 0\n";
  for (int v = 0; v < 8; ++v) shorter += "0 0 0\n";
  expect_error(shorter, "11 vertices and 0 faces do not fit the 59 bytes");
  expect_error("OFF\n0 0 0\n", "no vertices");
}

TEST(OffReader, RefusesOtherKinds) {
  expect_error("", "does not begin with OFF");
  expect_error("OFFER\n", "does not begin with OFF");
  expect_error("OFF BINARY\n", "binary OFF files are not supported");
  expect_error("4OFF\n1 0 0\n0 0 0 1\n", "only vertices in three dimensions");
}

}  // namespace
}  // namespace rlpc
