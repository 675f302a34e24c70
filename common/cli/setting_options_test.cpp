#include "common/cli/setting_options.h"

#include <gtest/gtest.h>

#include <array>

namespace rlpc {
namespace {

constexpr std::array<SettingOption, 4> kTable{{{"gof_frames", "--gof"},
                                               {"profile", "--profile"},
                                               {"rdo = false", "--no-rdo"},
                                               {"clusters", "--clusters"}}};

TEST(SettingOptions, SettingsBecomeOptions) {
  EXPECT_EQ(with_options("use a smaller 'gof_frames', or split it", kTable),
            "use a smaller --gof, or split it");
  EXPECT_EQ(with_options("'rdo = false' needs 'clusters'", kTable),
            "--no-rdo needs --clusters");
}

TEST(SettingOptions, ValuesFollowTheOption) {
  EXPECT_EQ(with_options("use 'profile = high'.", kTable), "use --profile high.");
}

TEST(SettingOptions, OtherQuotesStay) {
  for (const char* const text :
       {"", "'", "''", "the mesh's 'own'", "'unknown = 1'", "rdo = false", "'rdo'",
        "`gof_frames` of a file", "vertices' positions"}) {
    EXPECT_EQ(with_options(text, kTable), text);
  }
  EXPECT_EQ(with_options("the file's 'profile'", kTable), "the file's --profile");
}

}  // namespace
}  // namespace rlpc
