#include "common/files/messages.h"

#include <gtest/gtest.h>

#include <string>

namespace rlpc {
namespace {

TEST(Messages, KeepsTextInAnyLanguage) {
  for (const char* text : {"", "a b/c.rlpc", "\xC3\xA4", "\xE6\xBC\xA2", "\xF0\x9F\x90\x84",
                           "back\\slash", "\xE2\x82\xAC"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Messages, EscapesTerminalControls) {
  EXPECT_EQ(printable("\x1B[31m"), "\\x1B[31m");
  EXPECT_EQ(printable("a\rb\nc\td\x7F"), "a\\x0Db\\x0Ac\\x09d\\x7F");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\\xC2\\x9B31m");                                     // CSI as one character
  EXPECT_EQ(printable("\xE2\x80\xAEgpj"), "\\xE2\\x80\\xAEgpj");  // right-to-left override
  EXPECT_EQ(printable("\xE2\x81\xA7"), "\\xE2\\x81\\xA7");
  EXPECT_EQ(printable("\xE2\x80\xA8"), "\\xE2\\x80\\xA8");
}

TEST(Messages, EscapesInvalidUtf8) {
  EXPECT_EQ(printable("\x9B"
                      "31m"),
            "\\x9B31m");                           // CSI in eight bits
  EXPECT_EQ(printable("\xC0\x9B"), "\\xC0\\x9B");  // overlong
  EXPECT_EQ(printable("\xE0\x80\x9B"), "\\xE0\\x80\\x9B");
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xED\\xA0\\x80");  // half of a surrogate pair
  EXPECT_EQ(printable("\xF5\x80\x80\x80"), "\\xF5\\x80\\x80\\x80");
  EXPECT_EQ(printable("\xE6\xBC"), "\\xE6\\xBC");  // cut off
  EXPECT_EQ(printable("\xE6\x1B\xA2"), "\\xE6\\x1B\\xA2");
}

TEST(Messages, KeepsLineEndsOnRequest) {
  EXPECT_EQ(printable_lines("a\n\tb\r\n"), "a\n\tb\\x0D\n");
}

TEST(Messages, SizesAreInTheUnitOfTheFewestDigits) {
  EXPECT_EQ(size_text(0), "0 bytes");
  EXPECT_EQ(size_text(1023), "1023 bytes");
  EXPECT_EQ(size_text(1024), "1 KiB");
  EXPECT_EQ(size_text(500 << 20), "500 MiB");
  EXPECT_EQ(size_text((500 << 20) + 1), "524288001 bytes");
  EXPECT_EQ(size_text(std::uint64_t{5} << 40), "5120 GiB");
  EXPECT_EQ(size_text(200'000), "200 kB");
  EXPECT_EQ(size_text(2'000'000), "2 MB");
  EXPECT_EQ(size_text(128'000'000), "128 MB");  // 125000 KiB
  EXPECT_EQ(size_text(std::uint64_t{5'000'000'000'000}), "5000 GB");
}

TEST(Messages, CountsAreInTheSingularOrPlural) {
  EXPECT_EQ(count_text(1, "frame"), "1 frame");
  EXPECT_EQ(count_text(0, "frame"), "0 frames");
  EXPECT_EQ(count_text(1, "vertex", "vertices"), "1 vertex");
  EXPECT_EQ(count_text(2, "vertex", "vertices"), "2 vertices");
}

}  // namespace
}  // namespace rlpc
