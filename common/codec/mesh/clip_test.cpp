#include "common/codec/mesh/clip.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

TEST(ClipName, MayHaveAnyCharacters) {
  for (const std::string name :
       {"Run", "Armature|TRex_Run", " ", "~", "\u00A0", "\u07FF", "\u0800", "\uD7FF", "\uE000",
        "\uFFFF", "\U00010000", "\U0010FFFF", "\u8D70\u308A"}) {
    EXPECT_EQ(find_clip_name_error(name), name.size()) << name;
  }
}

TEST(ClipName, HasNoControlCharacters) {
  for (const std::string& wrong :
       {std::string(1, '\0'), std::string("\x1F"), std::string("\x7F"), std::string("\xC2\x80"),
        std::string("\xC2\x9F")}) {
    EXPECT_EQ(find_clip_name_error("ab" + wrong + "c"), 2U);
  }
}

TEST(ClipName, IsWellFormed) {
  for (const std::string wrong :
       {"\x80", "\xBF", "\xC1\xBF", "\xC2", "\xC2z", "\xE0\x9F\xBF", "\xE1\x80", "\xED\xA0\x80",
        "\xF0\x8F\xBF\xBF", "\xF1\x80\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF"}) {
    EXPECT_EQ(find_clip_name_error("a" + wrong), 1U) << wrong;
  }
}

}  // namespace
}  // namespace rlpc
