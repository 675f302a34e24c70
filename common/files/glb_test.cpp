#include "common/files/glb.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "common/files/binary_numbers.h"

namespace rlpc {
namespace {

const std::string kJson = R"({"asset":{"version":"2.0"}} )";  // 28 bytes
const std::string kBytes = "12345678";

std::string whole() { return glb_head(kJson, kBytes.size()) + kBytes; }

std::string problem_of(const std::string& glb) {
  const auto view = view_glb(glb);
  return view ? "" : view.error();
}

TEST(Glb, WhatIsWrittenIsRead) {
  for (const std::string json : {"{}", "{ }", "{\"a\":0}", "{\"asset\":1}"}) {
    for (const std::string& bytes : {std::string(), kBytes}) {
      const std::string glb = glb_head(json, bytes.size()) + bytes;
      EXPECT_EQ(glb.size() % 4, 0U);
      EXPECT_EQ(load_u32(glb, 8), glb.size());
      const auto view = view_glb(glb);
      ASSERT_TRUE(view) << view.error();
      EXPECT_EQ(view->json.substr(0, json.size()), json);
      EXPECT_EQ(view->json.find_first_not_of(' ', json.size()), std::string_view::npos);
      EXPECT_EQ(view->binary, bytes);
    }
  }
}

TEST(Glb, EveryPrefixIsRefused) {
  const std::string glb = whole();
  for (std::size_t size = 0; size < glb.size(); ++size) {
    EXPECT_NE(problem_of(glb.substr(0, size)), "") << size;
    std::string shorter = glb.substr(0, size);  // whose header tells its size
    if (size < 12) continue;
    std::string length;
    append_u32(length, static_cast<std::uint32_t>(size));
    shorter.replace(8, 4, length);
    // Without its second chunk, a file is whole.
    EXPECT_EQ(problem_of(shorter).empty(), size == 20 + kJson.size()) << size;
  }
}

TEST(Glb, SaysWhatIsWrong) {
  const auto changed = [](std::size_t at, const std::string& bytes) {
    std::string glb = whole();
    return problem_of(glb.replace(at, bytes.size(), bytes));
  };
  EXPECT_EQ(changed(0, "glXF"), "expected \"glTF\" at byte 0");
  EXPECT_EQ(changed(4, "\1").substr(0, 28), "version: found 1 at byte 4, ");
  EXPECT_EQ(changed(8, "\1").substr(0, 27), "length: found 1 at byte 8, ");
  EXPECT_EQ(changed(15, "\x7F").substr(0, 24), "chunk 0: found a length ");
  EXPECT_EQ(changed(16, "BIN"), "chunk 0: expected JSON in the first chunk");
  EXPECT_EQ(changed(24 + kJson.size(), "JSON"),
            "chunk 1: expected JSON in the first chunk only");
  EXPECT_EQ(problem_of(glb_head("", 0)), "chunk 0: expected JSON, found nothing");
}

TEST(Glb, SkipsChunksThatItDoesNotKnow) {
  std::string glb = whole();
  append_u32(glb, 4);
  glb += "EXTRmore";
  std::string length;
  append_u32(length, static_cast<std::uint32_t>(glb.size()));
  glb.replace(8, 4, length);
  const auto view = view_glb(glb);
  ASSERT_TRUE(view) << view.error();
  EXPECT_EQ(view->binary, kBytes);
}

TEST(Glb, FilesThatCannotBeReadHaveNoProblemOfTheirOwn) {
  for (const std::uint64_t last : {0U, 12U, 20U}) {
    const std::string glb = whole();
    const auto chunks =
        find_glb_chunks(glb.size(), [&](std::uint64_t at, std::span<char> bytes) {
          if (at >= last) return false;
          const std::string part = glb.substr(at, bytes.size());
          std::copy(part.begin(), part.end(), bytes.begin());
          return true;
        });
    ASSERT_FALSE(chunks);
    EXPECT_EQ(chunks.error(), "");
  }
}

}  // namespace
}  // namespace rlpc
