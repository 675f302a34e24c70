#include "encoder/codec/sequence/search_list.h"

#include <gtest/gtest.h>

#include <vector>

namespace rlpc {
namespace {

std::vector<Profile> profiles_of(const EncoderSettings& settings) {
  std::vector<Profile> profiles;
  for (const Search& search : list_searches(settings, 100, 300)) {
    EXPECT_EQ(search.may_be_given_up, search.settings.profile != settings.profile);
    profiles.push_back(search.settings.profile);
  }
  return profiles;
}

EncoderSettings settings_of(Profile profile) {
  EncoderSettings settings;
  settings.profile = profile;
  return settings;
}

using Profiles = std::vector<Profile>;

TEST(ListSearches, HasThoseOfTheProfilesThatAreContained) {
  EXPECT_EQ(profiles_of(settings_of(Profile::kBaseline)), Profiles{Profile::kBaseline});
  EXPECT_EQ(profiles_of(settings_of(Profile::kMain)),
            (Profiles{Profile::kMain, Profile::kBaseline}));
  EXPECT_EQ(profiles_of(settings_of(Profile::kHigh)),
            (Profiles{Profile::kHigh, Profile::kMain, Profile::kBaseline}));
}

TEST(ListSearches, LeavesOutThoseOfContainedProfilesWhereTheyTakeLong) {
  EncoderSettings settings = settings_of(Profile::kHigh);
  EXPECT_EQ(list_searches(settings, 1 << 10, 1 << 8).size(), 3U);
  EXPECT_EQ(list_searches(settings, 1 << 10, (1 << 8) + 1).size(), 1U);
  EXPECT_EQ(list_searches(settings, 1U << 31, 2).size(), 1U);  // not taken as 0
}

TEST(ListSearches, HasOneWhereToolsAreAskedFor) {
  for (const Profile profile : {Profile::kMain, Profile::kHigh}) {
    EncoderSettings settings = settings_of(profile);
    settings.main.bones = 3;
    EXPECT_EQ(profiles_of(settings), Profiles{profile});
    settings = settings_of(profile);
    settings.gof_kind = GofKind::kSkinned;
    EXPECT_EQ(profiles_of(settings), Profiles{profile});
    settings = settings_of(profile);
    settings.components = 9;
    EXPECT_EQ(profiles_of(settings), Profiles{profile});
    settings = settings_of(profile);
    settings.target = {Target::kNone, 0.0};
    EXPECT_EQ(profiles_of(settings), Profiles{profile});
  }
}

TEST(ListSearches, OfPresetSlowAreThoseOfMediumToo) {
  EncoderSettings settings = settings_of(Profile::kMain);
  settings.preset = Preset::kSlow;
  EXPECT_EQ(profiles_of(settings),
            (Profiles{Profile::kMain, Profile::kMain, Profile::kBaseline, Profile::kBaseline}));
  settings.gof_frames = EncoderSettings::kWholeSequence;  // also as several GOFs
  EXPECT_EQ(profiles_of(settings).size(), 8U);
}

}  // namespace
}  // namespace rlpc
