// Errors of glTF documents state the place, what was found and what was expected.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/source.h"
#include "encoder/testing/gltf_files.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

class GltfErrorsTest : public GltfFilesTest {
 protected:
  void expect_error(const GltfBuilder& builder, const std::string& part) const {
    const std::string error = error_of(builder);
    EXPECT_TRUE(error.starts_with((folder_ / "a.glb: ").string())) << error;
    expect_text(error, part);
  }
  // Expects an error after a valid document is modified in one place.
  void expect_broken(const GltfBuilder& good, const std::function<void(Json&)>& change,
                     const std::string& part) const {
    GltfBuilder builder = good;
    change(builder.json);
    expect_error(builder, part);
  }
};

TEST_F(GltfErrorsTest, InconsistentContainers) {
  const std::string good = one_triangle().glb();
  const auto expect_changed = [&](std::size_t at, const std::string& bytes,
                                  const std::string& part) {
    std::string bad = good;
    bad.replace(at, bytes.size(), bytes);
    expect_text(error_of_file(put("a.glb", bad)), part);
  };
  const std::size_t json_size = good.find("BIN") - 4 - 20;
  expect_changed(4, std::string("\1\0\0\0", 4), "version: found 1 at byte 4, expected 2");
  expect_changed(8, "\xFF\xFF\xFF\xFF", "length: found 4294967295 at byte 8, expected");
  expect_changed(12, "\xFF\xFF\xFF\x7F", "chunk 0: found a length of 2147483647 bytes");
  expect_changed(16, "BIN", "chunk 0: expected JSON");
  expect_changed(20 + json_size, std::string("\x2C\0\0\0", 4),
                 "chunk 1: found a length of 44 bytes, expected at most 36");
  expect_changed(20 + json_size + 4, "JSON", "chunk 1: expected JSON in the first chunk only");
  expect_changed(20 + json_size + 4, "XXXX", "buffers[0].uri: found nothing, expected a URI");
  expect_changed(20, "[", "not a glTF document: line 1, column");
  expect_text(error_of_file(put("a.glb", good + "more")), "length: found");
  expect_text(error_of_file(put("a.gltf", "")), "the file is empty");
  expect_text(error_of_file(put("a.gltf", "solid")), "not a glTF document: line 1, column");
  expect_text(error_of_file(put("a.gltf", "[1]")), "found an array of 1, expected an object");
  expect_text(error_of_file(put("a.gltf", "{}")), "asset.version: found nothing");
  expect_text(error_of_file((folder_ / "none.glb").string()), "none.glb: no such file");
}

TEST_F(GltfErrorsTest, ExtensionsThatChangeTheMesh) {
  const auto require = [](const char* name) {
    return [name](Json& json) { json["extensionsRequired"] = {"KHR_texture_transform", name}; };
  };
  const GltfBuilder good = one_triangle();
  expect_broken(good, require("KHR_draco_mesh_compression"),
                "extensionsRequired[1]: found \"KHR_draco_mesh_compression\", expected no "
                "extension that changes the mesh; export the file again without compression");
  expect_broken(good, require("EXT_meshopt_compression"), "without compression of meshes");
  expect_broken(good, require("EXT_mesh_gpu_instancing"), "export the file again without it");
  expect_broken(
      good, [](Json& j) { j["asset"]["version"] = "1.0"; }, "asset.version: found");
  expect_broken(
      good, [](Json& j) { j["asset"]["minVersion"] = "2.1"; }, "asset.minVersion");
}

TEST_F(GltfErrorsTest, WrongJsonTypes) {
  const GltfBuilder good = moving_triangle();
  const auto set = [](const char* pointer, const Json& value) {
    return [=](Json& json) { json[Json::json_pointer(pointer)] = value; };
  };
  expect_broken(good, set("/accessors/0/count", -3),
                "accessors[0].count: found -3, expected an integer from 1 to 9007199254740992");
  expect_broken(good, set("/accessors/0/count", "3"), "accessors[0].count: found \"3\"");
  expect_broken(good, set("/accessors/0/count", 3.5), "accessors[0].count: found 3.5");
  expect_broken(good, set("/accessors/0/count", std::numeric_limits<std::uint64_t>::max()),
                "accessors[0].count: found 18446744073709551615");
  expect_broken(good, set("/accessors/0/byteOffset", -4), "accessors[0].byteOffset: found -4");
  expect_broken(good, set("/accessors/0/componentType", 5124), "found 5124, expected 5120 to");
  expect_broken(good, set("/accessors/0/type", "VEC5"), "accessors[0].type: found \"VEC5\"");
  expect_broken(good, set("/accessors/0/normalized", 1), "found 1, expected true or false");
  expect_broken(good, set("/accessors", Json::object()),
                "accessors: found an object, expected");
  expect_broken(good, set("/accessors/0", 1), "accessors[0]: found 1, expected an object");
  expect_broken(good, set("/meshes/0/primitives/0/mode", 7), "primitives[0].mode: found 7");
  expect_broken(
      good, set("/meshes/0/primitives/0/indices", 4294967296),
      "indices: found 4294967296, expected an index of accessors, of which there are 3");
  expect_broken(good, set("/nodes/0/mesh", 1), "nodes[0].mesh: found 1, expected an index of");
  expect_broken(good, set("/nodes/0/rotation", {0, 0, 1}),
                "nodes[0].rotation: found an array of 3, expected an array of 4 numbers");
  expect_broken(good, set("/nodes/0/scale", {1, "2", 3}),
                "nodes[0].scale[1]: found \"2\", expected a number");
  expect_broken(good, set("/nodes/0/rotation", {0, 0, 0, 0}), "expected a unit quaternion");
  expect_broken(good, set("/nodes/0/skin", 0), "of skins, of which there are 0");
  expect_broken(good, set("/scene", 1), "scene: found 1, expected an index of scenes");
  expect_broken(good, set("/meshes/0/weights", {1}), "meshes[0].weights: found an array of 1");
  expect_broken(
      good, set("/animations/0/samplers/0/interpolation", "CUBIC"),
      "animations[0].samplers[0].interpolation: found \"CUBIC\", expected \"LINEAR\"");
  expect_broken(good, set("/animations/0/channels/0/sampler", 1),
                "animations[0].channels[0].sampler: found 1");
  expect_broken(good, set("/animations/0/channels/0/target/path", "colour"),
                "channels[0].target.path: found \"colour\"");
  expect_broken(good, set("/animations/0/channels/0/target/node", 9), "target.node: found 9");
  for (const std::string list : {"images", "textures", "samplers"}) {
    for (const Json& value : {Json(5), Json::object(), Json("a")}) {
      expect_broken(good, set(("/" + list).c_str(), value), list + ": found ");
    }
  }
}

TEST_F(GltfErrorsTest, RangesOutsideTheirBuffers) {
  const GltfBuilder good = moving_triangle();
  const auto set = [](const char* pointer, const Json& value) {
    return [=](Json& json) { json[Json::json_pointer(pointer)] = value; };
  };
  expect_broken(
      good, set("/accessors/0/count", 4),
      "accessors[0].count: found 4, expected at most 3, as many as fit the 36 bytes of "
      "bufferViews[0]");
  expect_broken(good, set("/accessors/0/count", 833333334),
                "found 833333334, expected at most 3");
  expect_broken(good, set("/accessors/0/byteOffset", 4), "accessors[0].count: found 3");
  expect_broken(good, set("/accessors/0/byteOffset", 28), "accessors[0].byteOffset: found 28");
  expect_broken(good, set("/accessors/0/byteOffset", 9007199254740992),
                "byteOffset: found 9007");
  expect_broken(good, set("/accessors/0/bufferView", 3),
                "of bufferViews, of which there are 3");
  expect_broken(good, set("/bufferViews/0/byteStride", 8), "expected a byteStride of 12");
  expect_broken(good, set("/bufferViews/0/byteStride", 256), "byteStride: found 256");
  expect_broken(good, set("/bufferViews/0/byteLength", 10737418240),
                "bufferViews[0].byteLength: found 10737418240, expected at most 84, what "
                "buffers[0] has from 0 on");
  expect_broken(good, set("/bufferViews/2/byteOffset", 85),
                "bufferViews[2].byteOffset: found 85");
  expect_broken(good, set("/bufferViews/2/buffer", 1), "of buffers, of which there are 1");
  expect_broken(good, set("/buffers", {{{"byteLength", 10737418240}}}),
                "buffers[0].byteLength: found 10737418240, expected at most 84, the bytes");
  GltfBuilder second = good;
  second.json["buffers"] = {{{"byteLength", 84}}, {{"byteLength", 84}}};
  second.json["bufferViews"][0]["buffer"] = 1;
  expect_error(second, "buffers[1].uri: found nothing, expected a URI; only the first buffer");
}

TEST_F(GltfErrorsTest, MissingBuffers) {
  const GltfBuilder builder = one_triangle();
  const auto expect_uri = [&](const std::string& uri, const std::string& part) {
    expect_text(error_of_file(put("in/a.gltf", builder.gltf(uri))), part);
  };
  put("outside.bin", builder.bytes);
  put("in/short.bin", builder.bytes.substr(1));
  expect_uri("none.bin", "none.bin: no such file");
  expect_uri("short.bin", "buffers[0].byteLength: found 36, expected at most 35");
  expect_uri("", "not a regular file");
  for (const char* uri :
       {"../outside.bin", "x/../../outside.bin", "/etc/passwd", "/no/such/file.bin",
        "%2e%2e/outside.bin", "file:outside.bin", "https://example.org/a.bin"}) {
    expect_uri(uri, "expected a file in the folder of the document, or below it");
  }
  const std::filesystem::path in = folder_ / "in";
  std::filesystem::create_symlink("../outside.bin", in / "link.bin");
  std::filesystem::create_directory_symlink("..", in / "up");
  std::filesystem::create_symlink("link.bin", in / "again.bin");
  std::filesystem::create_symlink("/dev/zero", in / "zero.bin");
  for (const char* uri : {"link.bin", "up/outside.bin", "again.bin", "zero.bin"}) {
    expect_uri(uri, "expected a file in the folder of the document, or below it");
  }
  expect_uri("data:,abc", "buffers[0].uri: found \"data:,abc\", expected data in base64");
  expect_uri("data:a/b;base64,AAAA*AAA", "expected data in base64");
  expect_uri("data:a/b;base64,AAAA", "buffers[0].byteLength: found 36, expected at most 3");
}

TEST_F(GltfErrorsTest, NonFiniteValues) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  GltfBuilder builder = moving_triangle();
  std::size_t bad = builder.add("VEC3", std::vector<float>{0, 0, 0, 1, nan, 0, 0, 1, 0});
  builder.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = bad;
  expect_error(builder, "accessors[3], element 1: found NaN, expected finite numbers");
  builder = moving_triangle();
  bad = builder.add("VEC3", std::vector<float>{0, 0, 0, 1, 0, 0, -infinity, 1, 0});
  builder.json["animations"][0]["samplers"][0]["output"] = bad;
  expect_error(builder, "accessors[3], element 2: found infinity, expected finite numbers");
  builder = moving_triangle();
  builder.json["nodes"][0]["scale"] = {1e300, 1, 1};
  expect_error(builder, "frame 0, vertex 1 (both from 0): x is infinite");
  EXPECT_NE(error_of_file(put("a.gltf", R"({"asset": {"version": "2.0"}, "a": 1e999})")), "");
}

TEST_F(GltfErrorsTest, NodesThatAreNotATree) {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"] = {{{"children", {1, 2}}}, {{"mesh", 0}}, {{"children", {1}}}};
  expect_error(builder,
               "nodes[2].children: found 1, expected no node that is a child of nodes[0]");
  builder.json["nodes"] = {{{"mesh", 0}, {"children", {1, 1}}}, Json::object()};
  expect_error(builder, "nodes[0].children: found 1");
  builder.json["nodes"] = {
      {{"mesh", 0}}, {{"children", {2}}}, {{"children", {3}}}, {{"children", {2}}}};
  expect_error(builder, "nodes[3].children: found 2");
  builder.json["nodes"] = {
      {{"mesh", 0}}, {{"children", {2}}}, {{"children", {1, 3}}}, Json::object()};
  expect_error(builder, "nodes[1]: found a node that is its own ancestor, expected no cycle");
  builder.json["nodes"] = {{{"mesh", 0}, {"children", {0}}}};
  expect_error(builder, "nodes[0]: found a node that is its own ancestor");
  builder.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, Json::object()};
  builder.json["scenes"][0]["nodes"] = {0, 1};
  expect_error(builder, "scenes: found nodes[1], expected nodes without parent; it is a child");
  builder.json["scenes"][0]["nodes"] = {0, 0};
  expect_error(builder, "scenes: found nodes[0] twice");
  builder.json["scenes"][0]["nodes"] = Json::array();
  expect_error(builder, "scenes: expected a mesh with triangles");
}

TEST_F(GltfErrorsTest, InvalidAnimations) {
  const GltfBuilder good = moving_triangle();
  const auto expect_sampler = [&](const char* part, const std::vector<float>& times,
                                  const std::vector<float>& values, const char* how = "LINEAR",
                                  const char* path = "translation", const char* type = "VEC3") {
    GltfBuilder builder = one_triangle();
    builder.push("animations", Json::object());
    const std::size_t input = builder.add("SCALAR", times);
    builder.add_channel(0, path, input, builder.add(type, values), how);
    expect_error(builder, part);
  };
  const char* const order = "accessors[1], element 2: found 1, expected a time after";
  expect_sampler(order, {0, 1, 1}, std::vector<float>(9));
  expect_sampler(order, {0, 2, 1}, std::vector<float>(9));
  expect_sampler("accessors[2].count: found 3, expected 2, 1 for each of the 2 times", {0, 1},
                 std::vector<float>(9));
  expect_sampler("accessors[2].count: found 2, expected 6, 3 for each", {0, 1},
                 std::vector<float>(6), "CUBICSPLINE");
  expect_sampler("accessors[2].type: found VEC3, expected VEC4", {0, 1}, std::vector<float>(6),
                 "LINEAR", "rotation");
  expect_sampler("accessors[2], element 1: found zeros, expected a unit quaternion", {0, 1},
                 {0, 0, 0, 1, 0, 0, 0, 0}, "LINEAR", "rotation", "VEC4");
  expect_sampler("nodes[0].mesh: found none with morph targets", {0, 1}, {0, 1}, "LINEAR",
                 "weights", "SCALAR");
  GltfBuilder builder = good;
  builder.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  expect_error(builder, "nodes[0]: found a matrix, expected translation, rotation and scale");
  builder = good;
  builder.json["animations"][0]["channels"].push_back(
      builder.json["animations"][0]["channels"][0]);
  expect_error(builder,
               "animations[0].channels[1].target: found an object, expected another node");
  builder = good;
  builder.add("SCALAR", std::vector<std::uint16_t>{0, 1, 2});
  builder.json["animations"][0]["samplers"][0]["input"] = 3;
  expect_error(builder, "accessors[3].componentType: found 5123, expected 5126");
  expect_text(
      error_of(good, {"Run"}),
      "animations: no \"Run\" there; expected all, an index below 1, or one of \"Move\"");
  expect_text(error_of(good, {"1"}), "no \"1\" there");
  for (const std::string again : {"Move", "0", "all"}) {
    expect_text(error_of(good, {"Move", again}), "animations: \"Move\" is chosen twice");
  }
  expect_text(error_of(one_triangle(), {"0"}), "no \"0\" there; the file has none");
  EXPECT_NE(error_of(one_triangle(), {"all"}).find("none there"), std::string::npos);
}

TEST_F(GltfErrorsTest, InvalidMeshes) {
  const auto with_indices = [](const std::vector<std::uint16_t>& indices, int mode) {
    GltfBuilder builder = one_triangle();
    Json& primitive = builder.json["meshes"][0]["primitives"][0];
    primitive["indices"] = builder.add("SCALAR", indices);
    primitive["mode"] = mode;
    return builder;
  };
  expect_error(with_indices({0, 1, 3}, 4),
               "accessors[1], element 2: found vertex 3, expected "
               "vertices below 3, those of meshes[0].primitives[0]");
  expect_error(with_indices({0, 1, 2, 65535, 0, 1, 2}, 5), "element 3: found vertex 65535");
  expect_error(with_indices({0, 1, 2, 0}, 4),
               "accessors[1].count: found 4, expected a multiple");
  GltfBuilder builder = one_triangle();
  Json& primitive = builder.json["meshes"][0]["primitives"][0];
  const std::size_t two = builder.add("VEC3", std::vector<float>(6));
  primitive["targets"] = {{{"POSITION", two}}};
  expect_error(builder, "accessors[1].count: found 2, expected 3, one for each vertex");
  builder.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}});
  expect_error(builder, "meshes[0].primitives[1].targets: found nothing, expected 1 targets");
  builder = one_triangle();
  builder.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      builder.add("VEC2", std::vector<float>(6));
  expect_error(builder, "accessors[1].type: found VEC2, expected VEC3");
  builder = one_triangle();
  builder.json["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices",
       {{"bufferView", builder.add_view(std::vector<std::uint8_t>{1, 1})},
        {"componentType", 5121}}},
      {"values", {{"bufferView", 0}}}};
  expect_error(builder,
               "accessors[0].sparse.indices, number 1: found 1, expected indices that");
  builder.json["accessors"][0]["sparse"]["count"] = 4;
  expect_error(builder, "accessors[0].sparse.count: found 4, expected an integer from 1 to 3");
}

TEST_F(GltfErrorsTest, InvalidSkins) {
  GltfBuilder good = one_triangle();
  Json& attributes = good.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = good.add("VEC4", std::vector<std::uint8_t>(12, 1));
  attributes["WEIGHTS_0"] = good.add("VEC4", std::vector<float>(12, 0.25F));
  good.add_root(Json::object());
  good.push("skins", {{"joints", {0, 1}}});
  good.json["nodes"][0]["skin"] = 0;
  EXPECT_EQ(error_of(good), "");
  const auto attribute = [](Json& json, const char* name) -> Json& {
    return json["meshes"][0]["primitives"][0]["attributes"][name];
  };
  expect_broken(
      good, [](Json& j) { j["skins"][0]["joints"] = {1}; },
      "accessors[1], element 0: found joint 1, expected joints below 1");
  expect_broken(
      good,
      [](Json& j) {
        j["skins"][0]["joints"] = {1, 2};
      },
      "skins[0].joints[1]: found 2");
  expect_broken(
      good, [](Json& j) { j["skins"][0]["joints"] = Json::array(); },
      "skins[0].joints: found an array of 0, expected an array of nodes");
  expect_broken(
      good, [](Json& j) { j["skins"][0]["inverseBindMatrices"] = 0; },
      "accessors[0].type: found VEC3, expected MAT4");
  expect_broken(
      good, [&](Json& j) { attribute(j, "JOINTS_0") = 2; },
      "accessors[2].componentType: found 5126, expected 5121, 5123 or 5125");
  expect_broken(
      good, [&](Json& j) { attribute(j, "JOINTS_1") = 1; },
      "as many sets of JOINTS_ (2) as of WEIGHTS_ (1)");
  expect_broken(
      good,
      [&](Json& j) {
        j["meshes"][0]["primitives"][0]["attributes"].erase("JOINTS_0");
        j["meshes"][0]["primitives"][0]["attributes"].erase("WEIGHTS_0");
      },
      "found no JOINTS_0 and WEIGHTS_0, expected them");
  GltfBuilder bad = good;
  attribute(bad.json, "WEIGHTS_0") = bad.add("VEC4", std::vector<float>(12, -1));
  expect_error(bad, "accessors[3], element 0: found -1.000000, expected weights of 0 or more");
  bad = good;
  bad.json["skins"][0]["inverseBindMatrices"] = bad.add("MAT4", std::vector<float>(16));
  expect_error(bad, "accessors[3].count: found 1, expected 2, one for each joint of skins[0]");
}

}  // namespace
}  // namespace rlpc
