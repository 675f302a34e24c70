// Tests that all contents of an input are in the stream, or named.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/scratch_folder.h"
#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/frame_stream.h"
#include "encoder/meshes/input_notes.h"
#include "encoder/meshes/open/open_source.h"
#include "encoder/testing/gltf_builder.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

void put_number(std::string& bytes, std::uint32_t value, bool big_endian) {
  for (int i = 0; i < 4; ++i) {
    bytes += static_cast<char>(value >> 8 * (big_endian ? 3 - i : i));
  }
}
void put_float(std::string& bytes, float value, bool big_endian) {
  put_number(bytes, std::bit_cast<std::uint32_t>(value), big_endian);
}

// Returns a PC2 file of three points and two samples.
std::string pc2(float start, float rate) {
  std::string bytes("POINTCACHE2\0\1\0\0\0\3\0\0\0", 20);
  put_float(bytes, start, false);
  put_float(bytes, rate, false);
  put_number(bytes, 2, false);
  for (int i = 0; i < 18; ++i) put_float(bytes, static_cast<float>(i % 5), false);
  return bytes;
}

std::string mdd(const std::vector<float>& times) {
  std::string bytes;
  put_number(bytes, static_cast<std::uint32_t>(times.size()), true);
  put_number(bytes, 3, true);
  for (const float time : times) put_float(bytes, time, true);
  for (std::size_t i = 0; i < 9 * times.size(); ++i) {
    put_float(bytes, static_cast<float>(i % 5), true);
  }
  return bytes;
}

class LossesTest : public ScratchFolderTest {
 protected:
  // Returns all notes, a line each, or the error.
  static std::string notes_of(const InputOptions& options) {
    const auto source = open_frame_source(options);
    if (!source) return source.error().message;
    std::vector<float> xyz(3 * std::size_t{(*source)->num_vertices()});
    for (std::uint32_t f = 0; f < (*source)->num_frames(); ++f) {
      if (const auto error = (*source)->read_frame(f, xyz)) return error->message;
    }
    std::string text;
    for (const std::string& note : (*source)->notes()) {
      EXPECT_TRUE(tells_loss(note)) << note;
      text += note + "\n";
    }
    return text;
  }
  static void expect_named(const InputOptions& options, const std::vector<std::string>& names) {
    const std::string notes = notes_of(options);
    for (const std::string& name : names) {
      EXPECT_NE(notes.find(name), std::string::npos) << name << "\n" << notes;
    }
  }
};

TEST_F(LossesTest, NamesWhatObjFilesHaveAndStreamsHaveNot) {
  const std::string mesh = put(
      "a.obj",
      "mtllib a.mtl\nmtllib b.mtl\nv 0 0 0 0.5\nv 1 0 0 7 7\nv 0 1 0\nvt 0 0 0.5\nvn 0 0 1\n"
      "vp 1 2\ns 1\nmg 2\nbevel on\nusemap m\nshow all\nf 1/1/1 2/1/1 3/1/1\nl 1 2\np 1\np 2\n"
      "cstype bezier\ncurv 0 1 1 2\nend\n");
  put("a.mtl", "newmtl a\nmap_Ks gloss.png\n");
  expect_named({mesh, "", {}},
               {"lines (1)", "points (2)", "smoothing groups", "merging groups",
                "free-form curves and surfaces", "settings of display", "usemap",
                "weights of vertices (1)", "numbers after vertices that are no colour (1)",
                "third texture coordinates (1)",
                "unknown lines, the first of them \"show\" (1)", "b.mtl", "gloss.png"});
  // These stay, or mean nothing.
  EXPECT_EQ(notes_of({put("b.obj",
                          "# by hand\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\n"
                          "vt 0 0\nvn 0 0 1\ns off\nf 1/1/1 2/1/1 3/1/1\n"),
                      "",
                      {}}),
            "");
  EXPECT_EQ(notes_of({put("c.obj", "v 0 0 0 1\nv 1 0 0 1.0\nv 0 1 0\nf 1 2 3\n"), "", {}}), "");
}

TEST_F(LossesTest, NamesParametersOfMaterialsThatStreamsHaveNot) {
  const auto notes_with = [&](const std::string& mtl) {
    put("m.mtl", mtl);
    return notes_of({put("m.obj", "mtllib m.mtl\nusemtl a\n" + kTriangle), "", {}});
  };
  const std::string all =
      "Ks 1 1 1\nKa .3 .3 .3\nillum 2\nNi 1.7\nTf 0 1 0\nsharpness 3\nPs .5\nPc .4\nPcr .2\n"
      "aniso .5\nanisor .1\nthing 3\n";
  const std::string notes = notes_with("newmtl a\nKd 1 0 0\nNs 300\nPr .1\nPm .9\n" + all +
                                       "newmtl spare\nKd 0 0 1\nwhatever 1\n");
  EXPECT_EQ(notes,
            "dropped: parameters of materials (Ks, Ka, illum, Ni, Tf, sharpness, Ps, Pc, Pcr, "
            "aniso, anisor, thing, Ns where Pr is given), 1 material that no face uses "
            "(\"spare\")\n");
  EXPECT_EQ(notes_with("newmtl a\nKd 1 0 2\nd -halo 0.5\n"),
            "dropped: parameters of materials (Kd outside 0 to 1, d)\n");
  // Values that mean nothing, and values that are kept.
  EXPECT_EQ(notes_with("# by hand\nnewmtl a\nKd 1 0 0\nKe 0 1 0\nd 0.5\nPr 0.1\nPm 1\n"
                       "Ks 0 0 0\nKa 0 0 0\nTf 1 1 1\nNi 1\nPc 0\n"),
            "");
  EXPECT_EQ(notes_with("newmtl a\nKd 1 0 0\nNs 300\n"), "");
}

// 100,000 lines are reported once, and only some of them.
TEST_F(LossesTest, TellsOfFewOfManyMaterialFiles) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += "mtllib " + std::to_string(i % 1000) + ".mtl\n";
  const std::string notes = notes_of({put("m.obj", text + kTriangle), "", {}});
  EXPECT_EQ(std::count(notes.begin(), notes.end(), '\n'), 6) << notes;
  EXPECT_NE(notes.find("995 other .mtl files"), std::string::npos) << notes;
}

// The message names the limit, not a part of it that nobody has set.
TEST_F(LossesTest, NamesTheMemoryLimitThatIsSet) {
  put("m.mtl", "newmtl a\nKd 1 0 0\n" + std::string(3000000, '#') + "\n");
  InputOptions options{
      put("m.obj", "mtllib m.mtl\nusemtl a\n" + kTriangle + "usemtl b\nf 1 2 3\n"), "", {}};
  options.max_memory_bytes = 100000000;
  expect_named(options, {"the limit of 100 MB ('max_memory_bytes')"});
}

TEST_F(LossesTest, NamesWhatPlyFilesHaveAndStreamsHaveNot) {
  const std::string mesh = put(
      "a.ply",
      "ply\nformat ascii 1.0\nobj_info scan 7\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nproperty float stress\nproperty float vx\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty list uchar int "
      "n\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty int id\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
      "0 0 0 5 1 255 0 0 0\n1 0 0 5 1 255 0 0 0\n0 1 0 5 1 255 0 0 0\n3 0 1 2 7 1 2 3\n0 1\n");
  expect_named({mesh, "", {}}, {"\"stress\", \"vx\", \"n\" of vertices",
                                "\"id\", \"red\", \"green\", \"blue\" of faces",
                                "element \"edge\" (1)", "obj_info"});
}

TEST_F(LossesTest, NamesWhatOffFilesHaveAndStreamsHaveNot) {
  expect_named(
      {put("a.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0\n0 1 0\n3 0 1 2 1 0 0\n"), "", {}},
      {"numbers after the positions of vertices", "colours of faces"});
  EXPECT_EQ(notes_of({put("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0 # c\n3 0 1 2\n"), "", {}}),
            "");
}

TEST_F(LossesTest, NamesTheTimesOfPointCaches) {
  const std::string mesh = put("a.obj", kTriangle);
  const auto points = [&](const std::string& name, const std::string& bytes) {
    return InputOptions{mesh, put(name, bytes), {}};
  };
  EXPECT_EQ(notes_of(points("a.pc2", pc2(0, 1))), "");
  expect_named(points("b.pc2", pc2(-10, 0.5F)), {"start -10, sample rate 0.5", "'frame_rate'"});
  EXPECT_EQ(notes_of(points("a.mdd", mdd({0, 0.04F, 0.08F}))), "");
  expect_named(points("b.mdd", mdd({0, 0.04F, 0.2F})), {"uneven frame times", "'frame_rate'"});
  expect_named(points("c.mdd", mdd({1, 1.04F, 1.08F})), {"start 1 of the frame times"});
  expect_named(points("d.mdd", mdd({0, 1, 2})),
               {"interval 1 of the frame times", "'frame_rate'"});
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<std::pair<std::vector<float>, const char*>> losses{
      {{0, 0.04F, 0.2F}, "uneven frame times"},
      {{0, 0.04F, 0.085F}, "uneven frame times"},
      {{0.08F, 0.04F, 0}, "not finite and ascending"},
      {{0, 0.08F, 0.04F}, "not finite and ascending"},
      {{0, infinity, 1}, "not finite and ascending"},
      {{0, 0.04F, std::nanf("")}, "not finite and ascending"},
      {{0, 0, 0}, "which are all 0"},
      {{2, 2, 2}, "which are all 2"}};
  for (const auto& [times, text] : losses) {
    InputOptions options = points("e.mdd", mdd(times));
    expect_named(options, {text, "'frame_rate'"});
    options.frame_rate = FrameRate{25, 1};
    expect_named(options, {text});
  }
  expect_named(points("f.pc2", pc2(infinity, 1)), {"start and sample rate"});
  expect_named(points("g.pc2", pc2(0, std::nanf(""))), {"start and sample rate"});
}

TEST_F(LossesTest, NamesTheHeaderOfAPipedPointCache) {
  const std::string mesh = put("a.obj", kTriangle);
  std::FILE* const file = std::fopen(put("a.pc2", pc2(5, 1)).c_str(), "rb");
  const auto stream = open_frame_stream(file, mesh, {});
  ASSERT_TRUE(stream) << stream.error().message;
  ASSERT_EQ((*stream)->shape().notes.size(), 1U);
  EXPECT_NE((*stream)->shape().notes[0].find("start 5"), std::string::npos);
  std::fclose(file);
}

TEST_F(LossesTest, NamesWhatLaterFramesHaveOtherwise) {
  const auto frame = [](const std::string& library, const std::string& more) {
    return "mtllib " + library + "\n" + kTriangle + more;
  };
  put("a.mtl", "newmtl m\nKd 1 0 0\n");
  put("same.mtl", "newmtl m\nKd 1 0 0\n");
  put("other.mtl", "newmtl m\nKd 0 1 0\nmap_Kd skin.png\n");
  put("f1.obj", frame("a.mtl", "usemtl m\nf 1 2 3\n"));
  put("f2.obj", frame("same.mtl", "usemtl m\nf 1 2 3\n"));
  EXPECT_EQ(notes_of({path("f%d.obj"), "", {}}), "");
  put("f3.obj", frame("other.mtl", "usemtl m\nf 1 2 3\np 1\n"));
  put("f4.obj", frame("a.mtl", "usemtl n\nf 1 2 3\nl 1 2\n"));
  expect_named({path("f%d.obj"), "", {}},
               {"f3.obj: materials (.mtl) are dropped", "f3.obj: textures are dropped",
                "f3.obj: dropped: points (1)", "f4.obj: names of materials are dropped"});
}

// Builds a triangle with two morph targets, of which the animation moves the second.
GltfBuilder morphing_triangle() {
  GltfBuilder builder;
  const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::size_t positions = builder.add("VEC3", corners);
  const std::size_t target = builder.add("VEC3", corners);
  const std::size_t mesh =
      builder.add_mesh({{"attributes", {{"POSITION", positions}}},
                        {"targets", {{{"POSITION", target}}, {{"POSITION", target}}}}});
  builder.json["meshes"][mesh]["extras"]["targetNames"] = {"jawOpen", "smile"};
  const std::size_t node = builder.add_root({{"mesh", mesh}});
  builder.push("animations", Json::object());
  const std::size_t input = builder.add("SCALAR", std::vector<float>{0, 1});
  const std::size_t output = builder.add("SCALAR", std::vector<float>{0.5F, 0, 0.5F, 1});
  builder.add_channel(node, "weights", input, output, "LINEAR");
  return builder;
}

TEST_F(LossesTest, NamesMorphTargets) {
  GltfBuilder builder = morphing_triangle();
  EXPECT_EQ(
      notes_of({put("a.glb", builder.glb()), "", {}}),
      "dropped: 1 morph target that no animation moves (jawOpen), morph targets (not their "
      "motion)\n");
  builder.json.erase("animations");
  expect_named({put("b.glb", builder.glb()), "", {}},
               {"2 morph targets that no animation moves (jawOpen, smile)"});
}

TEST_F(LossesTest, NamesTargetsThatOnlyOtherAnimationsMove) {
  GltfBuilder builder = morphing_triangle();
  Json other = builder.json["animations"][0];
  other["name"] = "other";
  other["channels"] = Json::array();
  builder.json["animations"].push_back(other);
  const std::string file = put("a.glb", builder.glb());
  expect_named({file, "", {}, {"1"}},
               {"2 morph targets that the chosen animations do not move"});
  expect_named({file, "", {}, {"all"}}, {"1 morph target that no animation moves (jawOpen)"});
}

TEST_F(LossesTest, NamesInformationAndExtensionsThatNoListNames) {
  GltfBuilder builder = morphing_triangle();
  builder.json["asset"]["copyright"] = "2026 Studio";
  builder.json["asset"]["author"] = "me";
  builder.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  builder.json["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = Json::array();
  builder.json["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  expect_named(
      {put("a.glb", builder.glb()), "", {}},
      {"asset information (\"author\", copyright)", "extension \"KHR_node_visibility\"",
       "extension \"MSFT_lod\"", "extension \"KHR_lights_punctual\""});
}

TEST_F(LossesTest, SaysThatColoursAreClamped) {
  GltfBuilder builder = morphing_triangle();
  Json& attributes = builder.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["COLOR_0"] =
      builder.add("VEC3", std::vector<float>{5, 0, -1, 0.25F, 1, 0, 0.5F, 0, 1});
  const std::string file = put("a.glb", builder.glb());
  expect_named({file, "", {}}, {"what 2 numbers of colours have outside 0 to 1"});
  const auto source = open_frame_source({file, "", {}});
  ASSERT_TRUE(source);
  EXPECT_EQ((*source)->attributes().sets.at(0).values,
            (std::vector<float>{1, 0, 0, 0.25F, 1, 0, 0.5F, 0, 1}));
}

TEST_F(LossesTest, NamesWhatGltfFilesHaveAndStreamsHaveNot) {
  GltfBuilder builder = morphing_triangle();
  Json& root = builder.json;
  Json& primitive = root["meshes"][0]["primitives"][0];
  const std::size_t pairs = builder.add("VEC2", std::vector<float>(6, 0.5F));
  primitive["attributes"]["TEXCOORD_1"] = pairs;  // TEXCOORD_0 is missing
  primitive["attributes"]["_HEAT"] = primitive["attributes"]["POSITION"];
  primitive["targets"][0]["COLOR_0"] = primitive["attributes"]["POSITION"];
  Json other = primitive;
  other.erase("targets");
  // `primitive` is not valid from here on.
  root["meshes"][0]["primitives"].push_back(
      Json::parse(R"({"attributes": {"_X": 0}, "targets": [{}, {}]})"));
  Json mesh = Json::object();
  mesh["primitives"].push_back(other);
  root["meshes"].push_back(mesh);
  root["scenes"].push_back({{"nodes", Json::array()}});
  root["cameras"] = Json::array({Json::object()});
  root["skins"] = Json::parse(R"([{"joints": [0]}])");
  root["extensions"]["KHR_lights_punctual"] = Json::object();
  root["extensions"]["KHR_materials_variants"] = Json::object();
  root["extensions"]["KHR_xmp_json_ld"] = Json::object();
  root["nodes"][0]["extensions"]["MPEG_thing"] = Json::object();
  root["nodes"][0]["extras"]["health"] = 5;
  root["scenes"][0]["extras"] = "note";
  builder.add_root({{"name", "socket"}});
  Json& channels = root["animations"][0]["channels"];
  for (const char* pointer :
       {"/materials/0/pbrMetallicRoughness/baseColorFactor", "/nodes/0/translation",
        "/cameras/0/perspective/yfov", "/extensions/KHR_lights_punctual/lights/0/color"}) {
    channels.push_back(
        {{"sampler", 0},
         {"target",
          {{"path", "pointer"},
           {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
  }
  expect_named(
      {put("a.glb", builder.glb()), "", {}},
      {"\"TEXCOORD_1\"", "\"_HEAT\"", "\"COLOR_0\" of morph targets",
       "1 primitive without positions", "1 mesh outside the scene", "1 other scene", "cameras",
       "skeleton", "lights", "variants of materials", "extension \"KHR_xmp_json_ld\"",
       "extension \"MPEG_thing\"", "extras of nodes, scenes", "1 empty node (\"socket\")",
       "animation of materials", "animation of nodes", "animation of cameras",
       "animation of lights", "jawOpen"});
}

TEST_F(LossesTest, SaysWhyAGltfFileShowsNothing) {
  GltfBuilder builder = morphing_triangle();
  builder.json.erase("animations");
  expect_named({put("a.glb", builder.glb()), "", {}, {"all"}}, {"none there, though all"});
  GltfBuilder alone;
  const std::size_t input = alone.add("SCALAR", std::vector<float>{0, 1});
  const std::size_t output = alone.add("VEC3", std::vector<float>(6, 1.0F));
  const std::size_t node = alone.add_root({{"name", "hips"}});
  alone.push("animations", Json::object());
  alone.add_channel(node, "translation", input, output, "LINEAR");
  expect_named({put("b.glb", alone.glb()), "", {}}, {"animations alone, and no mesh"});
}

TEST_F(LossesTest, RecognisesGitLfsPointers) {
  const std::string pointer =
      "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146\nsize 12345\n";
  const std::string mesh = put("a.obj", kTriangle);
  for (const char* name :
       {"p.obj", "p.ply", "p.off", "p.glb", "p.gltf", "p.rlpd", "p", "p.abc"}) {
    expect_named({put(name, pointer), "", {}}, {name, "Git LFS pointer", "git lfs pull"});
  }
  for (const char* name : {"p.pc2", "p.mdd", "cache"}) {
    expect_named({mesh, put(name, pointer), {}}, {"Git LFS pointer"});
  }
  put("f1.obj", kTriangle);
  put("f2.obj", pointer);
  expect_named({path("f%d.obj"), "", {}}, {"f2.obj: is a Git LFS pointer"});
}

TEST_F(LossesTest, SaysThatAFrameIsEmpty) {
  for (const char* text : {"# empty\n", "o thing\ng a\n", "\n"}) {
    expect_named({put("a.obj", text), "", {}}, {"an empty mesh"});
  }
  expect_named({put("b.ply",
                    "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\n"
                    "property float y\nproperty float z\nend_header\n"),
                "",
                {}},
               {"an empty mesh"});
  expect_named({put("c.off", "OFF\n0 0 0\n"), "", {}}, {"an empty mesh"});
  expect_named({put("d.obj", "hello world\n"), "", {}}, {"is this an OBJ file?"});
}

}  // namespace
}  // namespace rlpc
