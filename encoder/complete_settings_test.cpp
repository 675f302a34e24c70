#include "encoder/complete_settings.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/files/glb.h"

namespace rlpc {
namespace {

const std::vector<Clip> kClips{{"walk", 0, 3}};
// Texture coordinates of an image that no view holds have a use all the same.
const std::string kAsset = glb_head(
    R"({"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],"textures":[{}]})",
    0);

TEST(CompleteSettings, TakeWhatTheyLeaveOpen) {
  const EncoderSettings settings = complete_settings({}, kClips, kAsset);
  EXPECT_EQ(settings.clips, kClips);
  EXPECT_EQ(settings.asset, kAsset);
  EXPECT_EQ(settings.attributes.uv_uses.size(), 1U);
}

TEST(CompleteSettings, KeepWhatTheySay) {
  EncoderSettings asked;
  asked.clips = {{"run", 1, 1}};
  asked.asset = "another";
  const EncoderSettings settings = complete_settings(asked, kClips, kAsset);
  EXPECT_EQ(settings.clips, asked.clips);
  EXPECT_EQ(settings.asset, asked.asset);
  EXPECT_TRUE(settings.attributes.uv_uses.empty());
}

TEST(CompleteSettings, TakeNothingUnlessTheyMay) {
  EncoderSettings asked;
  asked.takes_from_source = false;
  const EncoderSettings settings = complete_settings(asked, kClips, kAsset);
  EXPECT_TRUE(settings.clips.empty());
  EXPECT_EQ(settings.asset, "");
}

TEST(CompleteSettings, TakeNoAssetWithoutAttributes) {
  EncoderSettings asked;
  asked.attributes.dropped = true;
  const EncoderSettings settings = complete_settings(asked, kClips, kAsset);
  EXPECT_EQ(settings.clips, kClips);
  EXPECT_EQ(settings.asset, "");
}

}  // namespace
}  // namespace rlpc
