// Documents with false claims of any kind give an error in bounded memory and time.

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/source.h"
#include "encoder/testing/gltf_files.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

class GltfClaimsTest : public GltfFilesTest {};

TEST_F(GltfClaimsTest, EveryProperPrefixFails) {
  const std::string good = moving_triangle().glb();
  EXPECT_EQ(error_of_file(put("a.glb", good)), "");
  for (std::size_t n = 0; n < good.size(); ++n) {
    ASSERT_NE(error_of_file(put("a.glb", good.substr(0, n))), "") << n;
  }
  const std::string text = one_triangle().gltf("a.bin");
  put("a.bin", one_triangle().bytes);
  EXPECT_EQ(error_of_file(put("a.gltf", text)), "");
  for (std::size_t n = 0; n < text.size(); ++n) {
    ASSERT_NE(error_of_file(put("a.gltf", text.substr(0, n))), "") << n;
  }
}

TEST_F(GltfClaimsTest, DeepNestingDoesNotExhaustTheStack) {
  const std::size_t depth = 1000000;
  const std::string deep = std::string(depth, '[') + std::string(depth, ']');
  for (const std::string& text :
       {deep, R"({"asset": {"version": "2.0", "extras": )" + deep + "}}"}) {
    expect_text(error_of_file(put("a.gltf", text)), "nested more than 100 levels deep");
  }
  GltfBuilder builder = one_triangle();
  Json nodes = builder.json["nodes"];
  for (std::size_t n = 0; n < 100000; ++n) builder.push("nodes", {{"children", {n + 2}}});
  builder.push("nodes", Json::object());
  EXPECT_EQ(error_of(builder), "");
}

// Replaces each value of a document with all features by an invalid one.
TEST_F(GltfClaimsTest, SurvivesAnyReplacedValue) {
  GltfBuilder good = moving_triangle();
  Json& primitive = good.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] = good.add("VEC4", std::vector<std::uint8_t>(12));
  primitive["attributes"]["WEIGHTS_0"] = good.add("VEC4", std::vector<float>(12, 1));
  primitive["indices"] = good.add("SCALAR", std::vector<std::uint16_t>{0, 1, 2});
  primitive["mode"] = 5;
  primitive["targets"] = {{{"POSITION", 0}}};
  good.json["meshes"][0]["weights"] = {0.5};
  good.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices",
       {{"bufferView", good.add_view(std::vector<std::uint8_t>{1})}, {"componentType", 5121}}},
      {"values", {{"bufferView", 0}, {"byteOffset", 12}}}};
  good.json["accessors"][0]["byteOffset"] = 0;
  good.json["nodes"][0].update({{"skin", 0}, {"children", {1}}, {"rotation", {0, 0, 0, 1}}});
  good.push("nodes", {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
  good.push("skins", {{"joints", {0, 1}}});
  good.json["buffers"] = {{{"byteLength", good.bytes.size()}}};
  ASSERT_EQ(error_of(good), "");
  const std::vector<Json> others{
      -1, 0,   1,     3,       4294967296,    9007199254740992, 1e300,     0.5,
      "", "a", false, nullptr, Json::array(), {1, 2},           {{"a", 1}}};
  GltfLimits limits;
  limits.max_positions = 1000;
  std::size_t refused = 0;
  const auto try_all = [&](const Json::json_pointer& place) {
    for (const Json& other : others) {
      GltfBuilder bad = good;
      bad.json[place] = other;
      const std::string error = error_of(bad, {"all"}, limits);
      EXPECT_TRUE(error.empty() || error.starts_with((folder_ / "a.glb: ").string()))
          << place.to_string() << " " << other << "\n"
          << error;
      if (!error.empty()) ++refused;
    }
  };
  std::set<std::string> places;
  const Json flat = good.json.flatten();
  for (const auto& [leaf, value] : flat.items()) {
    for (Json::json_pointer at(leaf); !at.empty(); at = at.parent_pointer()) {
      if (places.insert(at.to_string()).second) try_all(at);
    }
  }
  EXPECT_GT(refused, places.size() * others.size() / 2);
}

// A document of a few hundred bytes can claim anything.
TEST_F(GltfClaimsTest, ClaimsWithoutBytes) {
  GltfBuilder builder = one_triangle();
  builder.json["accessors"][0].erase("bufferView");
  builder.json["accessors"][0]["count"] = 833333334;  // 10 GB of zeros
  expect_text(error_of(builder),
              "meshes[0].primitives[0]: found 833333334 vertices more, expected at most");
  builder.json["accessors"][0]["count"] = 50000001;
  expect_text(error_of(builder), "accessors[0].count: found 50000001, expected at most");
  // Every node instantiates the mesh again.
  builder = one_triangle();
  for (int n = 0; n < 9; ++n) builder.add_root({{"mesh", 0}});
  GltfLimits limits;
  limits.max_vertices = 30;
  EXPECT_EQ(error_of(builder, {}, limits), "");
  limits.max_vertices = 29;
  expect_text(error_of(builder, {}, limits), "found 3 vertices more, expected at most 29");
  limits = {};
  limits.max_triangles = 9;
  expect_text(error_of(builder, {}, limits), "found more triangles, expected at most 9");
  // The same bytes are used repeatedly.
  builder = one_triangle();
  for (int t = 0; t < 99; ++t) {
    builder.json["meshes"][0]["primitives"][0]["targets"].push_back({{"POSITION", 0}});
  }
  limits = {};
  limits.spare_values = 0;
  builder.json["asset"]["extras"] = std::string(2000, 'x');
  EXPECT_EQ(error_of(builder, {}, limits), "");
  builder.json["accessors"][0]["count"] = 3;
  std::vector<float> many(9000);
  builder.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      builder.add("VEC3", many);
  for (Json& target : builder.json["meshes"][0]["primitives"][0]["targets"])
    target["POSITION"] = 1;
  expect_text(error_of(builder, {}, limits),
              "accessors[1].count: found 3000, expected at most");
}

// Memory and time do not grow with the product of nodes and targets or joints.
TEST_F(GltfClaimsTest, ProductsOfCounts) {
  constexpr std::size_t kMany = 30000;
  GltfBuilder builder = one_triangle();
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["targets"] = std::vector<Json>(kMany, Json::object());
  primitive["attributes"]["JOINTS_0"] =
      builder.add("VEC4", std::vector<std::uint16_t>(12, kMany - 1));
  primitive["attributes"]["WEIGHTS_0"] = builder.add("VEC4", std::vector<float>(12, 1));
  builder.push("skins", {{"joints", std::vector<std::size_t>(kMany, 0)}});
  for (std::size_t n = 0; n < kMany; ++n) builder.add_root({{"mesh", 0}, {"skin", 0}});
  EXPECT_EQ(error_of(builder), "");
}

// Any memory limit gives an error, or a source that reports its memory correctly.
TEST_F(GltfClaimsTest, MemoryHasALimit) {
  GltfBuilder builder = moving_triangle();
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["JOINTS_0"] = builder.add("VEC4", std::vector<std::uint8_t>(12));
  primitive["attributes"]["WEIGHTS_0"] = builder.add("VEC4", std::vector<float>(12, 1));
  primitive["targets"] = {{{"POSITION", 0}}};
  builder.push("skins", {{"joints", {0}}});
  builder.json["nodes"][0]["skin"] = 0;
  for (int n = 0; n < 9; ++n) builder.add_root({{"mesh", 0}});
  InputOptions options;
  options.path = put("a.glb", builder.glb());
  options.max_memory_bytes = 0;
  std::uint64_t refused = 0;
  for (;; options.max_memory_bytes += 1 + options.max_memory_bytes / 64) {
    const auto source = open_gltf(options);
    if (source) {
      EXPECT_LE((*source)->memory_bytes(), options.max_memory_bytes);
      EXPECT_GT((*source)->memory_bytes(), 30 * 128);
      break;
    }
    expect_text(source.error().message, "needs more memory than the limit of");
    ++refused;
  }
  EXPECT_GT(refused, 100);
}

TEST_F(GltfClaimsTest, HugeTimes) {
  GltfBuilder builder = moving_triangle();
  const auto last = [&](float time) {
    GltfBuilder copy = builder;
    copy.json["animations"][0]["samplers"][0]["input"] =
        copy.add("SCALAR", std::vector<float>{0, 1, time});
    return copy;
  };
  expect_text(error_of(last(3e38F)),
              "animations: found more frames of 3 vertices than the 16777216 that");
  expect_text(error_of(last(600000)), "choose one animation, or a lower 'frame_rate'");
  GltfLimits limits;
  limits.max_positions = 183;
  EXPECT_EQ(error_of(builder, {}, limits), "");
  limits.max_positions = 182;
  expect_text(error_of(builder, {}, limits), "than the 60 that are expected at most");
}

}  // namespace
}  // namespace rlpc
