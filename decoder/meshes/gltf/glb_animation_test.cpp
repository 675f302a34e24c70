#include "decoder/meshes/gltf/glb_animation.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

TEST(AnimationSpans, AreTheClips) {
  const std::vector<Clip> clips{{"Run", 0, 10}, {"Jump", 8, 12}};
  EXPECT_EQ(animation_spans(clips, 20, 0), clips);
  EXPECT_EQ(animation_spans({}, 20, 0), (std::vector<Clip>{{"", 0, 20}}));
}

TEST(AnimationSpans, HaveWhatIsBetweenClips) {
  const std::vector<Clip> clips{{"Run", 2, 3}, {"Jump", 7, 2}};
  EXPECT_EQ(animation_spans(clips, 10, 100), (std::vector<Clip>{{"Run", 2, 3},
                                                                {"Jump", 7, 2},
                                                                {"frames 100-101", 0, 2},
                                                                {"frames 105-106", 5, 2},
                                                                {"frames 109-109", 9, 1}}));
}

TEST(GlbAnimation, SharesTheTimesOfItsChannels) {
  GlbBuffers buffers;
  const Clip clip{"Run", 5, 4};
  GlbAnimation animation(buffers, clip, {2, 1});
  const std::vector<std::uint32_t> ends{0, 3};
  animation.add_channel(2, "translation", std::vector<std::uint32_t>{0}, 9);
  EXPECT_FALSE(animation.spans_clip());
  animation.add_channel(2, "rotation", ends, 10);
  EXPECT_TRUE(animation.spans_clip());
  animation.add_channel(3, "rotation", ends, 11);
  const GltfJson json = animation.json();
  EXPECT_EQ(json["name"], "Run");
  EXPECT_EQ(json["samplers"].size(), 3U);
  EXPECT_EQ(json["samplers"][1]["input"], json["samplers"][2]["input"]);
  const GltfJson& times = buffers.accessors()[json["samplers"][2]["input"].get<std::size_t>()];
  EXPECT_EQ(times["max"], GltfJson::array({1.5}));
  EXPECT_EQ(json["channels"][2]["target"]["node"], 3);
}

}  // namespace
}  // namespace rlpc
