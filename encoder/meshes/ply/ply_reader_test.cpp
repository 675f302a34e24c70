#include "encoder/meshes/ply/ply_reader.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace rlpc {
namespace {

const std::string kElements =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kText =
    "ply\nformat ascii 1.0\n" + kElements + "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n4 0 1 2 3\n";

void put(std::string& bytes, std::uint64_t value, std::size_t size, bool little_endian) {
  for (std::size_t i = 0; i < size; ++i) {
    bytes += static_cast<char>(value >> 8 * (little_endian ? i : size - 1 - i));
  }
}

// Returns the same mesh as kText.
std::string binary(bool little_endian, float last = 0.5F, std::uint64_t corner = 3) {
  std::string bytes = "ply\nformat binary_";
  bytes += (little_endian ? "little" : "big") + ("_endian 1.0\n" + kElements);
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 1.F, last}) {
    put(bytes, std::bit_cast<std::uint32_t>(x), 4, little_endian);
  }
  put(bytes, 4, 1, little_endian);
  for (const std::uint64_t v : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{2}, corner}) {
    put(bytes, v, 4, little_endian);
  }
  return bytes;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

void expect_mesh(const std::string& text) {
  const auto mesh = parse_ply(text, "a.ply");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->xyz, (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5F}));
  EXPECT_EQ(mesh->triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

void expect_error(const std::string& text, const std::string& part) {
  const auto mesh = parse_ply(text, "a.ply");
  ASSERT_FALSE(mesh) << part;
  EXPECT_NE(mesh.error().message.find(part), std::string::npos) << part << "\n"
                                                                << mesh.error().message;
}

TEST(PlyReader, ReadsEveryEncoding) {
  expect_mesh(kText);
  expect_mesh(binary(true));
  expect_mesh(binary(false));
}

TEST(PlyReader, ReadsEveryTypeOfNumber) {
  const auto bits_of = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  struct Case {
    std::vector<std::string> types;
    std::uint64_t bits;
    std::size_t size;
    float value;
  };
  const std::vector<Case> cases{{{"char", "int8"}, 0x80, 1, -128.0F},
                                {{"uchar", "uint8"}, 0x80, 1, 128.0F},
                                {{"short", "int16"}, 0x8001, 2, -32767.0F},
                                {{"ushort", "uint16"}, 0x8001, 2, 32769.0F},
                                {{"int", "int32"}, 0x80000100, 4, -2147483392.0F},
                                {{"uint", "uint32"}, 0x80000100, 4, 2147483904.0F},
                                {{"float", "float32"}, 0xBF000000, 4, -0.5F},
                                {{"double", "float64"}, bits_of(-0.75), 8, -0.75F}};
  for (const Case& number : cases) {
    for (const std::string& type : number.types) {
      for (const bool little_endian : {true, false}) {
        std::string bytes = "ply\nformat binary_";
        bytes += (little_endian ? "little" : "big") +
                 ("_endian 1.0\nelement vertex 1\nproperty " + type + " y\nproperty " + type +
                  " z\nproperty uchar x\nend_header\n");
        put(bytes, number.bits, number.size, little_endian);
        put(bytes, 0, number.size, little_endian);
        const auto mesh = parse_ply(bytes + "\7", "a.ply");
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_EQ(mesh->xyz, (std::vector<float>{7, number.value, 0})) << type;
      }
    }
  }
}

TEST(PlyReader, KeepsWhatFloatsLeaveOfDoubles) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty double x\n"
      "property double y\nproperty double z\nend_header\n";
  for (const double x : {0.5, 0.1, -0.3}) put(bytes, std::bit_cast<std::uint64_t>(x), 8, true);
  const auto mesh = parse_ply(bytes, "a.ply");
  ASSERT_TRUE(mesh) << mesh.error().message;
  const auto left_of = [](double x) { return x - static_cast<double>(static_cast<float>(x)); };
  EXPECT_EQ(mesh->left, (std::vector<double>{0, left_of(0.1), left_of(-0.3)}));
}

TEST(PlyReader, ReadsEveryLineEndOfTheHeader) {
  for (const std::string end : {"\r\n", "\r"}) {
    for (const std::string& text : {kText, binary(true)}) {
      const std::size_t body = text.find("end_header\n") + 11;
      std::string header;
      for (const char c : text.substr(0, body)) header += c == '\n' ? end : std::string(1, c);
      expect_mesh(header + text.substr(body));
    }
  }
}

TEST(PlyReader, SkipsUnknownElementsAndProperties) {
  expect_mesh(
      "ply\nformat ascii 1.0\ncomment by hand\nobj_info none\n"
      "element camera 2\nproperty list uchar float view\nproperty int id\n"
      "element face 1\nproperty uchar red\nproperty list uint8 uint16 vertex_index\n"
      "property list uchar float texcoord\n"
      "element vertex 4\nproperty uchar red\nproperty double z\nproperty short x\n"
      "property float32 y\nproperty list int int rings\nend_header\n"
      "3 0.5 1 2 7\n0 8\n9 4 0 1 2 3 2 0.25 0.75\n"
      "1 0 0 0 0\n2 0 1 0 1 5\n3 0 1 1 0\n4 0.5 0 1 2 6 7");
}

TEST(PlyReader, ReadsPointCloudsAndTheFrameRate) {
  const auto mesh = parse_ply(
      "ply\nformat ascii 1.0\ncomment frame_rate 30000/1001\nelement vertex 1\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n",
      "a.ply");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_TRUE(mesh->triangles.empty());
  EXPECT_EQ(mesh->frame_rate, (FrameRate{30000, 1001}));
}

TEST(PlyReader, EveryProperPrefixFails) {
  const std::string text = kText.substr(0, kText.size() - 1);  // the last line end is missing
  for (const std::string& whole : {text, binary(true), binary(false)}) {
    for (std::size_t n = 0; n < whole.size(); ++n) {
      const std::vector<char> exact(whole.begin(),
                                    whole.begin() + static_cast<std::ptrdiff_t>(n));
      const auto mesh = parse_ply(std::string_view(exact.data(), n), "a.ply");
      EXPECT_FALSE(mesh) << n;
    }
  }
}

TEST(PlyReader, NamesLineOrByteOfABadValue) {
  expect_error(replaced(kText, "1 1 0\n", "1 nan 0\n"), "a.ply:12: \"nan\" is not finite");
  expect_error(replaced(kText, "1 1 0\n", "1 1 1e39\n"), "a.ply:12: \"1e39\" is too large");
  expect_error(replaced(kText, "4 0 1 2 3", "4 0 1 2 4"),
               "a.ply:14: vertex index 4 is out of range 0 to 3");
  expect_error(replaced(kText, "4 0 1 2 3", "4 0 1 2 -1"), "a.ply:14: vertex index -1");
  expect_error(replaced(kText, "4 0 1 2 3", "2 0 1"), "a.ply:14: a face of 2 corners");
  expect_error(replaced(kText, "4 0 1 2 3", "-1"), "a.ply:14: a list of -1 values");
  expect_error(replaced(kText, "4 0 1 2 3", "4 0 1 2.5 3"), "\"2.5\" is not an integer");
  expect_error(kText + "5\n", "a.ply:15: has data after what the header announces");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const bool little_endian : {true, false}) {
    expect_error(binary(little_endian, nan),
                 "a.ply: byte " + std::to_string(binary(little_endian).size() - 21) +
                     ": a coordinate is not a number");
    expect_error(binary(little_endian, 0, 0xFFFFFFFF), ": vertex index -1 is out of range");
    expect_error(binary(little_endian) + "x", "has data after what the header announces");
  }
}

TEST(PlyReader, RefusesCountsThatDoNotFitTheFile) {
  expect_error(replaced(binary(true), "vertex 4", "vertex 4294967295"),
               "a.ply: element \"vertex\": 4294967295 of them need at least 51539607540 bytes, "
               "but 65 are left");
  expect_error(replaced(kText, "face 1", "face 4000000000"), "4000000000 of them need");
  expect_error(replaced(kText, "vertex 4", "vertex 4294967296"),
               "a.ply:3: element \"vertex\": \"4294967296\" of them");
  expect_error(replaced(kText, "vertex 4", "vertex -4"), "\"-4\" of them");
  expect_error(replaced(kText, "vertex 4", "vertex 0"), "no vertices");
  std::string lying = binary(true);
  lying[lying.size() - 17] = '\xFF';  // corners of the face
  expect_error(lying, "the file ends before all values");
}

TEST(PlyReader, RefusesBrokenHeaders) {
  expect_error("", "a.ply:1: does not begin with a line \"ply\"");
  expect_error(replaced(kText, "ascii", "binary"), "a.ply:2: format \"binary\"");
  expect_error(replaced(kText, "1.0", "2.0"), "PLY version \"2.0\"");
  expect_error(replaced(kText, "format ascii 1.0\n", ""), "no line \"format\"");
  expect_error(replaced(kText, "float y", "quad y"), "a.ply:5: \"quad\" is not a PLY type");
  expect_error(replaced(kText, "float y", "float x"), "a second property \"x\"");
  expect_error(replaced(kText, "float y", "float w"), "element \"vertex\" has no number y");
  expect_error(replaced(kText, "list uchar", "list float"), "not an integer");
  expect_error(replaced(kText, "uchar int", "uchar float"), "no list of integers");
  expect_error(replaced(kText, "element face", "element vertex"), "a second element");
  expect_error(replaced(kText, "element face 1", "elements face 1"),
               "\"elements\" does not begin");
  expect_error(replaced(kText, "element face", "element tristrips"),
               "strips are not supported");
  expect_error("ply\nformat ascii 1.0\nproperty int x\n", "before the first element");
  expect_error("ply\nformat ascii 1.0\nelement many 9\nend_header\n", "has no property");
}

}  // namespace
}  // namespace rlpc
