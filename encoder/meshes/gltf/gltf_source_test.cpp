#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/source.h"
#include "encoder/meshes/open/open_source.h"
#include "encoder/testing/gltf_files.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

const float kHalf = 0.70710678F;  // sine and cosine of 45 degrees

class GltfSourceTest : public GltfFilesTest {};

TEST_F(GltfSourceTest, ReadsAMeshWithoutAnimationAsOneFrame) {
  const auto source = open(one_triangle());
  EXPECT_EQ(source->num_frames(), 1U);
  EXPECT_EQ(source->frame_rate(), (FrameRate{30, 1}));
  EXPECT_EQ(source->triangles(), (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_TRUE(source->notes().empty());
  EXPECT_EQ(frame_of(*source, 0), kCorners);
}

TEST_F(GltfSourceTest, DetectsTheContainerByItsContents) {
  const GltfBuilder builder = one_triangle();
  for (const char* name : {"a.glb", "a.gltf", "a.GLB", "a.model", "a"}) {
    const auto source = open_frame_source({put(name, builder.glb()), "", {}});
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ(frame_of(**source, 0), kCorners);
  }
  put("a.bin", builder.bytes);
  for (const char* name : {"a.gltf", "a.glb", "a.json", "a"}) {
    const auto source = open_frame_source({put(name, "\n " + builder.gltf("a.bin")), "", {}});
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ(frame_of(**source, 0), kCorners);
  }
}

TEST_F(GltfSourceTest, ReadsBuffersWhereverTheyAre) {
  GltfBuilder builder;
  const std::size_t indices = builder.add("SCALAR", std::vector<std::uint16_t>{2, 1, 0});
  const std::size_t positions = builder.add("VEC3", kCorners);
  builder.add_root({{"mesh", builder.add_mesh({{"attributes", {{"POSITION", positions}}},
                                               {"indices", indices}})}});
  put("data/a b.bin", builder.bytes + "more");
  // Links may lead to another place below the document, which may be seen through one itself.
  std::filesystem::create_symlink("data/a b.bin", folder_ / "link.bin");
  std::filesystem::create_directory_symlink(folder_, folder_ / "data" / "self");
  // 2, 1, 0 in 16 bits each, a gap, and the corners.
  const std::string base64 =
      "data:application/gltf-buffer;base64,AgABAAAAAAAAAAAAAAAAAAAAAAAAAI"
      "A/AAAAAAAAAAAAAAAAAACAPwAAAAA=";
  for (const std::string& uri : {std::string("data/a%20b.bin"), std::string("./data/a b.bin"),
                                 std::string("link.bin"), base64}) {
    const auto source = open_gltf({put("a.gltf", builder.gltf(uri)), "", {}, {}, false});
    ASSERT_TRUE(source) << source.error().message;
    EXPECT_EQ((*source)->triangles(), (std::vector<Triangle>{{2, 1, 0}}));
    EXPECT_EQ(frame_of(**source, 0), kCorners) << uri;
  }
  put("a.gltf", builder.gltf("link.bin"));
  const std::string path = (folder_ / "data" / "self" / "a.gltf").string();
  EXPECT_TRUE(open_gltf({path, "", {}, {}, false}));
}

TEST_F(GltfSourceTest, PutsVerticesInTheOrderOfTheScene) {
  GltfBuilder builder;
  const auto mesh_of = [&](float x) {
    std::vector<Json> primitives;
    for (const float more : {0.0F, 0.5F}) {
      const std::vector<float> xyz{x + more, 0, 0, 0, 1, 0, 0, 0, 1};
      primitives.push_back({{"attributes", {{"POSITION", builder.add("VEC3", xyz)}}}});
    }
    return builder.push("meshes", {{"primitives", primitives}});
  };
  const std::size_t first = mesh_of(1);
  const std::size_t second = mesh_of(2);
  builder.json["nodes"] = {{{"mesh", second}, {"translation", {10, 0, 0}}},
                           {{"children", {3, 0}}, {"translation", {100, 0, 0}}},
                           {{"mesh", first}},
                           {{"mesh", first}, {"scale", {2, 2, 2}}},
                           {{"mesh", first}}};
  builder.json["scenes"][0]["nodes"] = {1, 4};  // node 2 is in no scene
  const auto source = open(builder);
  const std::vector<float> xyz = frame_of(*source, 0);
  std::vector<float> x;
  for (std::size_t i = 0; i < xyz.size(); i += 9) x.push_back(xyz[i]);
  EXPECT_EQ(x, (std::vector<float>{102, 103, 112, 112.5, 1, 1.5}));
  EXPECT_EQ(source->triangles()[5], (Triangle{15, 16, 17}));
  builder.json.erase("scenes");
  builder.json.erase("scene");
  EXPECT_EQ(open(builder)->num_vertices(), 24U);  // all roots, node 2 among them
}

TEST_F(GltfSourceTest, FlipsTrianglesOfMirroringNodes) {
  GltfBuilder builder = one_triangle();
  builder.add_root({{"mesh", 0}, {"scale", {1, -1, 1}}});
  EXPECT_EQ(open(builder)->triangles(), (std::vector<Triangle>{{0, 1, 2}, {3, 5, 4}}));
}

TEST_F(GltfSourceTest, FlipsTrianglesOfMirroringNodesWithSkins) {
  GltfBuilder builder = one_triangle();
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = builder.add("VEC4", std::vector<std::uint8_t>(12, 0));
  attributes["WEIGHTS_0"] =
      builder.add("VEC4", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
  builder.add_root({{"scale", {1, -1, 1}}});
  builder.push("skins", {{"joints", {1}}});
  builder.json["nodes"][0]["skin"] = 0;
  EXPECT_EQ(open(builder)->triangles(), (std::vector<Triangle>{{0, 1, 2}}));
  builder.json["nodes"][0]["scale"] = {1, -1, 1};  // moves nothing
  EXPECT_EQ(open(builder)->triangles(), (std::vector<Triangle>{{0, 2, 1}}));
}

TEST_F(GltfSourceTest, NormalsOfMirroringNodesFaceAsTheirTriangles) {
  GltfBuilder builder = one_triangle();
  builder.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      builder.add("VEC3", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1});
  builder.json["nodes"][0]["scale"] = {1, 1, -1};
  const auto source = open(builder);
  EXPECT_EQ(source->triangles(), (std::vector<Triangle>{{0, 2, 1}}));
  const SourceAttributes& all = source->attributes();
  EXPECT_EQ(all.sets[0].values, (std::vector<float>{0, 0, -1, 0, 0, -1, 0, 0, -1}));
  EXPECT_EQ(all.first_normals, (std::vector<float>{0, 0, -1, 0, 0, -1, 0, 0, -1}));
}

TEST_F(GltfSourceTest, FacesAsInTheFramesInWhichItIsLarge) {
  GltfBuilder builder = one_triangle();
  builder.push("animations", Json::object());
  const std::size_t times = builder.add("SCALAR", std::vector<float>{0, 1});
  const std::size_t scales =
      builder.add("VEC3", std::vector<float>{0.1F, 0.1F, 0.1F, 1, 1, -1});
  builder.add_channel(0, "scale", times, scales, "LINEAR");
  EXPECT_EQ(open(builder)->triangles(), (std::vector<Triangle>{{0, 2, 1}}));
}

TEST_F(GltfSourceTest, ShowsTheFirstSceneUnlessAnotherIsChosen) {
  GltfBuilder builder = one_triangle();
  builder.push("nodes", {{"mesh", 0}, {"translation", {5, 0, 0}}});
  builder.json["scenes"].push_back({{"nodes", {1}}});
  builder.json.erase("scene");
  EXPECT_EQ(frame_of(*open(builder), 0), kCorners);
  builder.json["scene"] = 1;
  EXPECT_EQ(frame_of(*open(builder), 0), (std::vector<float>{5, 0, 0, 6, 0, 0, 5, 1, 0}));
}

TEST_F(GltfSourceTest, FacesOfPrimitivesWithoutNormalsAreFlat) {
  GltfBuilder builder = one_triangle();
  Json smooth = builder.json["meshes"][0]["primitives"][0];
  smooth["attributes"]["NORMAL"] =
      builder.add("VEC3", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  builder.json["meshes"][0]["primitives"].push_back(smooth);
  builder.json["nodes"][0]["rotation"] = {kHalf, 0, 0, kHalf};  // z to -y
  const auto source = open(builder);
  EXPECT_TRUE(source->notes().empty());
  const SourceAttributes& all = source->attributes();
  ASSERT_EQ(all.sets[0].name, "normal");
  const auto corner_values = [&](const std::vector<float>& values, std::size_t corner) {
    const std::size_t i = all.sets[0].value_of_corner[corner];
    return std::vector<float>(values.begin() + static_cast<std::ptrdiff_t>(3 * i),
                              values.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
  };
  ASSERT_EQ(all.first_normals.size(), all.sets[0].values.size());
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(corner_values(all.sets[0].values, k), (std::vector<float>{0, 0, 1}));
    expect_near(corner_values(all.first_normals, k), {0, -1, 0});
  }
  expect_near(corner_values(all.sets[0].values, 4), {0, 1, 0});
  expect_near(corner_values(all.first_normals, 4), {0, 0, 1});
}

TEST_F(GltfSourceTest, AppliesMatricesOfNodes) {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"][0]["matrix"] = {0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1};
  EXPECT_EQ(frame_of(*open(builder), 0), (std::vector<float>{5, 6, 7, 5, 8, 7, 3, 6, 7}));
}

TEST_F(GltfSourceTest, CombinesScaleRotationTranslationAndParents) {
  GltfBuilder builder = one_triangle();
  builder.json["nodes"][0] = {{"mesh", 0}, {"scale", {2, 3, 4}}};
  builder.push(
      "nodes",
      {{"children", {0}}, {"rotation", {0, 0, kHalf, kHalf}}, {"translation", {10, 0, 0}}});
  builder.json["scenes"][0]["nodes"] = {1};
  expect_near(frame_of(*open(builder), 0), {10, 0, 0, 10, 2, 0, 7, 0, 0});
}

TEST_F(GltfSourceTest, SamplesFromTimeZeroToTheLastPose) {
  GltfBuilder builder = moving_triangle();
  EXPECT_EQ(open(builder)->num_frames(), 61U);
  EXPECT_EQ(open(builder, {}, false, {4, 1})->num_frames(), 9U);
  EXPECT_EQ(open(builder, {}, false, {30000, 1001})->num_frames(), 61U);
  const auto source = open(builder, {}, false, {4, 3});  // every 0.75 s
  EXPECT_EQ(source->num_frames(), 4U);
  for (const std::uint32_t f : {2U, 0U, 1U}) {
    EXPECT_FLOAT_EQ(frame_of(*source, f)[0], 0.75F * static_cast<float>(f));
  }
  EXPECT_FLOAT_EQ(frame_of(*source, 3)[0], 2);
  const auto later = builder.add("SCALAR", std::vector<float>{10, 11, 12.2F});
  builder.json["animations"][0]["samplers"][0]["input"] = later;
  const auto late = open(builder, {}, false, {5, 1});
  EXPECT_EQ(late->num_frames(), 62U);  // 12.2 as a float
  EXPECT_FLOAT_EQ(frame_of(*late, 0)[0], 0);
  EXPECT_FLOAT_EQ(frame_of(*late, 50)[0], 0);
  EXPECT_FLOAT_EQ(frame_of(*late, 55)[0], 1);
  EXPECT_FLOAT_EQ(frame_of(*late, 61)[0], 2);
  const auto end = builder.add("SCALAR", std::vector<float>{0, 1, 30725 / 30.0F});
  builder.json["animations"][0]["samplers"][0]["input"] = end;
  EXPECT_EQ(open(builder)->num_frames(), 30726U);  // 0.0015 of a frame short, as a float
}

TEST_F(GltfSourceTest, ChoosesAnimations) {
  GltfBuilder builder = moving_triangle();
  builder.push("animations", {{"name", "0"}});
  const std::size_t input = builder.add("SCALAR", std::vector<float>{1, 2});
  const std::size_t output = builder.add("VEC3", std::vector<float>{0, 7, 0, 0, 8, 0});
  builder.add_channel(0, "translation", input, output, "STEP");
  const FrameRate one{1, 1};
  EXPECT_EQ(open(builder, {}, false, one)->num_frames(), 3U);
  EXPECT_EQ(open(builder, {"Move"}, false, one)->num_frames(), 3U);
  for (const std::string second : {"1", "0"}) {  // names come before indices
    const auto source = open(builder, {second}, false, one);
    EXPECT_EQ(source->num_frames(), 3U);
    EXPECT_EQ(frame_of(*source, 0)[1], 7);
  }
  const auto all = open(builder, {"all"}, false, one);
  ASSERT_EQ(all->num_frames(), 6U);
  std::vector<float> first_vertex;
  for (const std::uint32_t f : {5U, 0U, 2U, 3U}) {
    const std::vector<float> xyz = frame_of(*all, f);
    first_vertex.insert(first_vertex.end(), xyz.begin(), xyz.begin() + 2);
  }
  EXPECT_EQ(first_vertex, (std::vector<float>{0, 8, 0, 0, 2, 0, 0, 7}));
}

TEST_F(GltfSourceTest, NamesTheClips) {
  GltfBuilder builder = moving_triangle();
  for (const char* const name : {"L\u00e4ufe\n2", ""}) {
    builder.push("animations", {{"name", name}});
    const std::size_t input = builder.add("SCALAR", std::vector<float>{0, 1});
    const std::size_t output = builder.add("VEC3", std::vector<float>{0, 7, 0, 0, 7, 0});
    builder.add_channel(0, "translation", input, output, "STEP");
  }
  const FrameRate one{1, 1};
  for (const bool weld : {false, true}) {
    EXPECT_EQ(
        open(builder, {"all"}, weld, one)->clips(),
        (std::vector<Clip>{{"Move", 0, 3}, {"L\u00e4ufe 2", 3, 2}, {"animation 2", 5, 2}}));
  }
  EXPECT_EQ(open(builder, {"1"}, false, one)->clips(),
            (std::vector<Clip>{{"L\u00e4ufe 2", 0, 2}}));
  EXPECT_TRUE(open(builder, {"2"}, false, one)->clips().empty());
  EXPECT_EQ(open(builder, {"1", "Move"}, false, one)->clips(),
            (std::vector<Clip>{{"L\u00e4ufe 2", 0, 2}, {"Move", 2, 3}}));
}

TEST_F(GltfSourceTest, NamesASingleClip) {
  const std::vector<Clip> clips{{"Move", 0, 61}};
  for (const std::vector<std::string>& choice :
       std::vector<std::vector<std::string>>{{}, {"Move"}, {"0"}, {"all"}}) {
    const auto source = open(moving_triangle(), choice);
    EXPECT_EQ(source->clips(), clips) << choice.size();
    EXPECT_TRUE(source->notes().empty()) << choice.size();
  }
  GltfBuilder nameless = moving_triangle();
  nameless.json["animations"][0].erase("name");
  EXPECT_TRUE(open(nameless, {"all"})->clips().empty());
  EXPECT_TRUE(open(one_triangle())->clips().empty());
}

TEST_F(GltfSourceTest, LastsAsLongAsTheLongestChannel) {
  GltfBuilder builder = moving_triangle();
  const std::size_t short_times = builder.add("SCALAR", std::vector<float>{0, 1});
  const std::size_t scales = builder.add("VEC3", std::vector<float>{1, 1, 1, 2, 2, 2});
  builder.add_channel(0, "scale", short_times, scales, "LINEAR");
  EXPECT_EQ(open(builder)->num_frames(), 61U);
}

TEST_F(GltfSourceTest, MovesRotatesAndScalesNodes) {
  GltfBuilder builder = one_triangle();
  builder.push("animations", Json::object());
  const std::size_t input = builder.add("SCALAR", std::vector<float>{0, 2});
  const auto track = [&](const char* path, const char* type, const std::vector<float>& values,
                         const char* how) {
    builder.add_channel(0, path, input, builder.add(type, values), how);
  };
  track("rotation", "VEC4", {0, 0, 0, 1, 0, 0, 1, 0}, "LINEAR");
  track("scale", "VEC3", {1, 1, 1, 3, 3, 3}, "LINEAR");
  track("translation", "VEC3", {0, 0, 5, 9, 9, 9}, "STEP");
  const auto source = open(builder, {}, false, {1, 1});
  // Half way, it is rotated by 90 degrees and twice the size; translation is not yet applied.
  expect_near(frame_of(*source, 1), {0, 0, 5, 0, 2, 5, -2, 0, 5});
  expect_near(frame_of(*source, 2), {9, 9, 9, 6, 9, 9, 9, 6, 9});
}

TEST_F(GltfSourceTest, ReadsRotationsAsNormalizedIntegers) {
  GltfBuilder builder = one_triangle();
  builder.push("animations", Json::object());
  const std::size_t input = builder.add("SCALAR", std::vector<float>{0, 1});
  const std::vector<std::int16_t> turns{0, 0, 0, 32767, 0, 0, 23170, 23170};
  builder.add_channel(0, "rotation", input, builder.add_normalized("VEC4", turns), "LINEAR");
  expect_near(frame_of(*open(builder, {}, false, {1, 1}), 1), {0, 0, 0, 0, 1, 0, -1, 0, 0});
}

TEST_F(GltfSourceTest, IgnoresAnimationByExtensionsWithANote) {
  GltfBuilder builder = moving_triangle();
  Json& channels = builder.json["animations"][0]["channels"];
  channels.push_back({{"sampler", 0},
                      {"target",
                       {{"path", "pointer"},
                        {"extensions", {{"KHR_animation_pointer", {{"pointer", "/x"}}}}}}}});
  const auto source = open(builder);
  EXPECT_EQ(source->num_frames(), 61U);
  EXPECT_EQ(source->notes(), (std::vector<std::string>{"dropped: animation of \"/x\""}));
}

TEST_F(GltfSourceTest, NotesOtherOmissions) {
  GltfBuilder builder = moving_triangle();
  builder.json["animations"].push_back(builder.json["animations"][0]);
  builder.json["animations"][1]["name"] = "Run";
  builder.json["extensionsUsed"] = {"KHR_materials_unlit", "EXT_mesh_gpu_instancing"};
  const auto source = open(builder);
  ASSERT_EQ(source->notes().size(), 2U);
  EXPECT_EQ(source->notes()[0],
            "EXT_mesh_gpu_instancing is ignored: the animation may show more or less");
  EXPECT_TRUE(source->notes()[1].starts_with("reading the first of 2 animations ("));
  EXPECT_NE(source->notes()[1].find("\"Run\""), std::string::npos);
  EXPECT_EQ(open(builder, {"all"})->notes().size(), 1U);
}

TEST_F(GltfSourceTest, ListsWhatItDrops) {
  GltfBuilder builder = one_triangle();
  EXPECT_TRUE(open(builder)->notes().empty());
  const std::vector<float> numbers(12, 0.5F);
  const std::size_t pairs = builder.add("VEC2", std::vector<float>(6, 0.5F));
  const std::size_t colours = builder.add("VEC4", numbers);
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["NORMAL"] = attributes["POSITION"];
  attributes["TEXCOORD_0"] = pairs;
  attributes["COLOR_0"] = colours;
  builder.json["materials"] = Json::array({Json::object()});
  builder.json["textures"] = Json::array({Json::object()});
  const auto source = open(builder);
  EXPECT_TRUE(source->notes().empty());
  EXPECT_EQ(source->attributes().sets.size(), 4U);  // material too, as the triangle has none
  EXPECT_TRUE(source->asset().starts_with("glTF"));
  attributes["TANGENT"] = colours;
  attributes["_HEAT"] = colours;
  builder.json["cameras"] = Json::array({Json::object()});
  builder.json["skins"] = Json::parse(R"([{"joints": [0]}])");
  builder.json["extensions"]["KHR_lights_punctual"] = Json::object();
  builder.json["extensions"]["KHR_materials_variants"] = Json::object();
  builder.json["nodes"][0]["name"] = "Hips";
  EXPECT_EQ(open(builder)->notes(),
            (std::vector<std::string>{
                "dropped: tangents, skeleton (not its motion), cameras, lights, variants of "
                "materials, attributes \"_HEAT\""}));
}

TEST_F(GltfSourceTest, RefusesEmptyMeshes) {
  GltfBuilder builder = one_triangle();
  builder.json["accessors"][0].erase("bufferView");
  builder.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0}};
  expect_text(error_of(builder), "found no bufferView, expected positions");
  GltfBuilder flat;
  const std::vector<float> xyz(9);
  flat.add_root(
      {{"mesh", flat.add_mesh({{"attributes", {{"POSITION", flat.add("VEC3", xyz)}}}})}});
  expect_text(error_of(flat), "all of them are degenerate");
  EXPECT_EQ(open(flat)->triangles().size(), 1U);  // not welded: its corners differ
}

TEST_F(GltfSourceTest, WeldsByDefault) {
  GltfBuilder builder;
  // Two triangles that share an edge, as six vertices, and a degenerate one.
  const std::vector<float> xyz{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1,
                               0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 0};
  builder.add_root(
      {{"mesh", builder.add_mesh({{"attributes", {{"POSITION", builder.add("VEC3", xyz)}}}})}});
  const auto apart = open(builder);
  EXPECT_EQ(apart->num_vertices(), 9U);
  EXPECT_EQ(apart->triangles().size(), 3U);
  EXPECT_TRUE(apart->notes().empty());
  const auto joined = open(builder, {}, true);
  EXPECT_EQ(frame_of(*joined, 0), (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}));
  EXPECT_EQ(joined->triangles(), (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(joined->notes(),
            (std::vector<std::string>{
                "merged 5 duplicate vertices (4 left); 'weld = false' keeps them apart",
                "dropped 1 degenerate triangle"}));
}

}  // namespace
}  // namespace rlpc
