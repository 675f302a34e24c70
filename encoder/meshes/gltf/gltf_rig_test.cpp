// The rig of a glTF document: maps of bones, applied to the rest shape, give the positions that
// the source reads, whatever the nodes and skins are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "encoder/meshes/axes.h"
#include "encoder/meshes/gltf/model.h"
#include "encoder/meshes/gltf/pose.h"
#include "encoder/meshes/gltf/rig.h"
#include "encoder/meshes/source_rig.h"
#include "encoder/meshes/weld.h"
#include "encoder/testing/gltf_files.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

class GltfRigTest : public GltfFilesTest {};

std::vector<double> exact_of(FrameSource& source, std::uint32_t frame) {
  std::vector<double> xyz(3 * std::size_t{source.num_vertices()});
  EXPECT_FALSE(source.read_exact(frame, xyz));
  return xyz;
}

// Returns the positions of a frame by the rig of the source.
std::vector<double> posed_by_rig(FrameSource& source, std::uint32_t frame) {
  const SourceRig& rig = *source.rig();
  std::vector<BoneMap> maps(rig.bones.size());
  source.read_bones(frame, maps);
  std::vector<double> xyz;
  for (std::size_t v = 0; v < source.num_vertices(); ++v) {
    std::array<double, 3> sum{};
    double total = 0.0;
    for (auto i = rig.first_influence[v]; i < rig.first_influence[v + 1]; ++i) {
      const double weight = static_cast<double>(rig.influences[i].weight);
      const BoneMap& map = maps[rig.influences[i].bone];
      for (std::size_t c = 0; c < 3; ++c) {
        double moved = map[c][3];
        for (std::size_t k = 0; k < 3; ++k) moved += map[c][k] * rig.rest[3 * v + k];
        sum[c] += weight * moved;
      }
      total += weight;
    }
    for (const double x : sum) xyz.push_back(x / total);
  }
  return xyz;
}

void expect_agreement(FrameSource& source) {
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    const std::vector<double> want = exact_of(source, f);
    const std::vector<double> got = posed_by_rig(source, f);
    ASSERT_EQ(got.size(), want.size());
    double size = 1e-6;
    for (const double x : want) size = std::max(size, std::abs(x));
    for (std::size_t i = 0; i < want.size(); ++i) {
      ASSERT_NEAR(got[i], want[i], 1e-7 * size) << "frame " << f << ", value " << i;
    }
  }
}

// Makes scenes of some nodes, skins and meshes, with all that exporters write.
class RandomScene {
 public:
  explicit RandomScene(std::uint32_t seed) : random_(seed) {
    const std::size_t num_nodes = 2 + below(9);
    for (std::size_t n = 0; n < num_nodes; ++n) add_node(n);
    builder_.push("animations", {{"name", "Walk"}});
    for (std::size_t n = 0; n < num_nodes; ++n) animate(n);
    const std::size_t num_skins = below(4);
    for (std::size_t s = 0; s < num_skins; ++s) add_skin(num_nodes);
    for (std::size_t n = 0; n < num_nodes; ++n) {
      if (below(3) == 0) add_mesh(n, num_skins);
    }
    add_mesh(num_nodes - 1, num_skins);
  }

  const GltfBuilder& builder() const { return builder_; }

 private:
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }
  float number() { return std::uniform_real_distribution<float>(-2.0F, 2.0F)(random_); }
  std::vector<float> numbers(std::size_t count) {
    std::vector<float> values(count);
    for (float& x : values) x = number();
    return values;
  }
  std::vector<float> rotation() {
    std::vector<float> q = numbers(4);
    float norm = 0.0F;
    for (const float x : q) norm += x * x;
    for (float& x : q) x /= std::sqrt(norm);
    return q;
  }
  // Scales are usual, uneven, mirroring, tiny or zero.
  std::vector<float> scale() {
    std::vector<float> even(3, 0.01F + std::abs(number()));
    switch (below(8)) {
      case 0:
        return numbers(3);
      case 1:
        return {-1, 1, 1};
      case 2:
        return {0, 0, 0};
      case 3:
        return {0.01F, 0.01F, 0.01F};
      case 4:
        return even;
      default:
        return {1, 1, 1};
    }
  }

  void add_node(std::size_t n) {
    const Json node{{"translation", numbers(3)}, {"rotation", rotation()}, {"scale", scale()}};
    if (n == 0 || below(5) == 0) {
      builder_.add_root(node);
    } else {
      builder_.push("nodes", node);
      builder_.json["nodes"][below(n)]["children"].push_back(n);
    }
  }

  void animate(std::size_t n) {
    const std::size_t input = builder_.add("SCALAR", std::vector<float>{0.0F, 0.1F, 0.2F});
    const auto keys = [&](auto&& value) {
      std::vector<float> all;
      for (int k = 0; k < 3; ++k) {
        const std::vector<float> one = value();
        all.insert(all.end(), one.begin(), one.end());
      }
      return all;
    };
    if (below(2) == 0 || n == 0) {
      builder_.add_channel(n, "rotation", input,
                           builder_.add("VEC4", keys([&] { return rotation(); })), "LINEAR");
    }
    if (below(3) == 0) {
      builder_.add_channel(n, "translation", input,
                           builder_.add("VEC3", keys([&] { return numbers(3); })), "LINEAR");
    }
    if (below(6) == 0) {
      builder_.add_channel(n, "scale", input,
                           builder_.add("VEC3", keys([&] { return scale(); })), "LINEAR");
    }
  }

  // Bind matrices are absent, those of some pose, or arbitrary.
  void add_skin(std::size_t num_nodes) {
    std::vector<std::size_t> joints;
    for (std::size_t n = 0; n < num_nodes; ++n) {
      if (below(2) == 0) joints.push_back(n);
    }
    if (joints.empty()) joints.push_back(below(num_nodes));
    Json skin{{"joints", joints}};
    const std::size_t form = below(3);
    if (form > 0) {
      std::vector<float> matrices;
      std::vector<float> same = numbers(12);
      for (std::size_t j = 0; j < joints.size(); ++j) {
        const std::vector<float> m = form == 1 ? same : numbers(12);
        for (std::size_t c = 0; c < 4; ++c) {
          for (std::size_t r = 0; r < 3; ++r) matrices.push_back(m[3 * c + r]);
          matrices.push_back(c == 3 ? 1.0F : 0.0F);
        }
      }
      skin["inverseBindMatrices"] = builder_.add("MAT4", matrices);
    }
    num_joints_.push_back(joints.size());
    builder_.push("skins", skin);
  }

  void add_mesh(std::size_t node, std::size_t num_skins) {
    Json& n = builder_.json["nodes"][node];
    if (n.contains("mesh")) return;
    constexpr std::size_t kVertices = 24;
    Json attributes{{"POSITION", builder_.add("VEC3", numbers(3 * kVertices))}};
    if (num_skins > 0 && below(4) != 0) {
      const std::size_t skin = below(num_skins);
      n["skin"] = skin;
      std::vector<std::uint8_t> joints;
      std::vector<float> weights;
      for (std::size_t i = 0; i < 4 * kVertices; ++i) {
        joints.push_back(static_cast<std::uint8_t>(below(num_joints_[skin])));
        weights.push_back(below(2) == 0 && i % 4 != 0 ? 0.0F : 0.1F + std::abs(number()));
      }
      attributes["JOINTS_0"] = builder_.add("VEC4", joints);
      attributes["WEIGHTS_0"] = builder_.add("VEC4", weights);
    }
    n["mesh"] = builder_.add_mesh({{"attributes", attributes}});
  }

  std::mt19937 random_;
  GltfBuilder builder_;
  std::vector<std::size_t> num_joints_;  // [skin]
};

TEST_F(GltfRigTest, MovesTheVerticesOfRandomScenes) {
  constexpr std::uint32_t kScenes = 400;
  std::size_t num_rigs = 0;
  for (std::uint32_t seed = 0; seed < kScenes; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    auto source =
        open_gltf({put("a.glb", RandomScene(seed).builder().glb()), "", {}, {}, false});
    ASSERT_TRUE(source) << source.error().message;
    if (!(*source)->rig()) continue;
    ++num_rigs;
    const SourceRig& rig = *(*source)->rig();
    for (std::size_t b = 0; b < rig.bones.size(); ++b) {
      ASSERT_LT(rig.bones[b].parent, static_cast<std::int32_t>(b));
      ASSERT_EQ(rig.bones[b].parent < 0, b == 0);
    }
    expect_agreement(**source);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(num_rigs, kScenes / 2);
}

TEST_F(GltfRigTest, FollowsWeldingAndAxes) {
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    auto source =
        open_gltf({put("a.glb", RandomScene(seed).builder().glb()), "", {}, {}, true});
    if (!source || !(*source)->rig()) continue;
    expect_agreement(**source);
    const auto axes = parse_axes("-z,x,y");
    ASSERT_TRUE(axes);
    expect_agreement(*turn_source(std::move(*source), *axes));
    if (HasFatalFailure()) return;
  }
}

TEST_F(GltfRigTest, IsAbsentWhereOneBoneMovesAll) {
  EXPECT_FALSE(open(moving_triangle())->rig());
}

// Triangles that nodes move, one each.
TEST_F(GltfRigTest, IsAbsentWhereBonesAreNearlyAsManyAsVertices) {
  GltfBuilder builder;
  const std::size_t mesh =
      builder.add_mesh({{"attributes", {{"POSITION", builder.add("VEC3", kCorners)}}}});
  for (int i = 0; i < 40; ++i) builder.add_root({{"mesh", mesh}});
  EXPECT_FALSE(open(builder)->rig());
}

// Skins that bind one joint in many places: each would need a bone, and a search for it.
TEST_F(GltfRigTest, IsAbsentWhereManySkinsBindAJointDifferently) {
  const auto bound = [](int num_skins) {
    GltfBuilder builder;
    const std::size_t joint = builder.add_root({{"translation", {1, 2, 3}}});
    const std::size_t other = builder.add_root({{"translation", {0, 0, 0}}});
    for (int i = 0; i < num_skins; ++i) {
      std::vector<float> both;
      for (const float x : {0.0F, static_cast<float>(i)}) {
        both.insert(both.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1});
      }
      const std::size_t skin = builder.push(
          "skins",
          {{"joints", {joint, other}}, {"inverseBindMatrices", builder.add("MAT4", both)}});
      std::vector<float> corners;
      std::vector<std::uint8_t> joints;
      std::vector<float> weights;
      for (int v = 0; v < 6; ++v) {
        const float x = static_cast<float>(v);
        corners.insert(corners.end(), {x, x * x, 0});
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.insert(weights.end(), {3, 1, 0, 0});
      }
      const Json attributes{{"POSITION", builder.add("VEC3", corners)},
                            {"JOINTS_0", builder.add("VEC4", joints)},
                            {"WEIGHTS_0", builder.add("VEC4", weights)}};
      builder.add_root(
          {{"skin", skin}, {"mesh", builder.add_mesh({{"attributes", attributes}})}});
    }
    return builder;
  };
  const auto few = open(bound(16));
  ASSERT_TRUE(few->rig());
  EXPECT_EQ(few->rig()->bones.size(), 18U);  // one of the first joint, 16, and the one above
  expect_agreement(*few);
  EXPECT_FALSE(open(bound(17))->rig());
}

TEST_F(GltfRigTest, IsAbsentWhereMemoryIsShort) {
  const std::string path = put("a.glb", RandomScene(3).builder().glb());
  const auto model = read_gltf_model({path, "", {}, {}, false}, {});
  ASSERT_TRUE(model) << model.error().message;
  const GltfPose pose = pose_of(model->nodes, model->scene, nullptr, 0.0);
  const std::vector<const GltfPose*> poses{&pose};
  const auto whole = gltf_rig(*model, poses, std::uint64_t{1} << 30).rig;
  ASSERT_TRUE(whole);
  EXPECT_TRUE(gltf_rig(*model, poses, whole->memory_bytes()).rig);
  EXPECT_FALSE(gltf_rig(*model, poses, whole->memory_bytes() / 2).rig);
}

TEST_F(GltfRigTest, IsAbsentIfItIsNotWanted) {
  InputOptions options{put("a.glb", RandomScene(3).builder().glb()), "", {}, {}, false};
  options.rig = false;
  EXPECT_FALSE((*open_gltf(options))->rig());
}

// Two skins of the same joint, whose meshes were bound in different places.
TEST_F(GltfRigTest, PlacesMeshesOfDifferentBindMatricesInOneRestShape) {
  constexpr int kVertices = 12;
  GltfBuilder builder;
  const std::size_t joint = builder.add_root({{"translation", {1, 2, 3}}});
  const std::size_t still = builder.add_root({{"translation", {0, 0, 0}}});
  for (const float x : {0.0F, 5.0F}) {
    const std::vector<float> bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1};
    std::vector<float> both = bind;
    both.insert(both.end(), bind.begin(), bind.end());
    const std::size_t skin = builder.push(
        "skins",
        {{"joints", {joint, still}}, {"inverseBindMatrices", builder.add("MAT4", both)}});
    std::vector<float> corners;
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
    for (int i = 0; i < kVertices; ++i) {
      corners.insert(corners.end(),
                     {0.5F * static_cast<float>(i) - x, static_cast<float>(i % 3), 0});
      joints.insert(joints.end(), {0, 1, 0, 0});
      weights.insert(weights.end(), {1.0F, static_cast<float>(i % 2), 0, 0});
    }
    const Json attributes{{"POSITION", builder.add("VEC3", corners)},
                          {"JOINTS_0", builder.add("VEC4", joints)},
                          {"WEIGHTS_0", builder.add("VEC4", weights)}};
    builder.add_root(
        {{"skin", skin}, {"mesh", builder.add_mesh({{"attributes", attributes}})}});
  }
  const auto source = open(builder);
  ASSERT_TRUE(source->rig());
  const SourceRig& rig = *source->rig();
  EXPECT_EQ(rig.bones.size(), 3U);  // the joints, and the one that joins them
  for (std::size_t i = 0; i < 3 * kVertices; ++i) {
    EXPECT_NEAR(rig.rest[i], rig.rest[3 * kVertices + i], 1e-9) << i;
  }
  expect_agreement(*source);
}

}  // namespace
}  // namespace rlpc
