// Tests that the memory of a JSON text as a tree, and while it is printed, stays below the
// estimate that is compared with the limit.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "common/files/glb.h"
#include "common/json/json.h"
#include "common/testing/random_json.h"
#include "conformance/testing/count_memory.h"
#include "decoder/meshes/stream_asset.h"

namespace rlpc {
namespace {

// Reads and prints a text; returns the peak of allocated memory without the text.
template <class Json>
std::size_t peak_of(const std::string& text) {
  const std::size_t before = memory_count.now;
  memory_count.peak = before;
  JsonProblem problem;
  const auto tree = read_json<Json>(text, UINT64_MAX, problem);
  EXPECT_TRUE(tree) << problem.message;
  if (tree) {
    EXPECT_FALSE(json_text(*tree, 2).empty());
  }
  return memory_count.peak - before;
}

std::uint64_t estimate_of(const std::string& text) {
  JsonShape shape;
  EXPECT_FALSE(measure_json(text, shape));
  return json_tree_bytes(shape, text.size());
}

template <class Json>
void expect_bounded(const std::string& text) {
  constexpr std::uint64_t kParserBytes = 2000;
  EXPECT_LE(peak_of<Json>(text), estimate_of(text) + kParserBytes) << text.substr(0, 200);
}

TEST(JsonMemory, IsBoundedForRandomTexts) {
  constexpr std::uint32_t kSeed = 4803;
  for (std::uint32_t i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    RandomJson random(kSeed + i);
    const std::string text = random.text(i % 2 == 0 ? 2000 : 40000, kMaxJsonDepth);
    expect_bounded<nlohmann::json>(text);
    expect_bounded<nlohmann::ordered_json>(text);
    expect_bounded<GltfJson>(text);
  }
}

TEST(JsonMemory, IsBoundedForOneKindOfValueWithoutEnd) {
  for (const char* const item :
       {"0", "[]", "{}", "\"\"", "[0]", "[[]]", "{\"a\":0}", "{\"a\":{}}",
        "\"0123456789abcdef\"", "{\"0123456789abcdef\":\"0123456789abcdef\"}"}) {
    // Numbers of items directly after which arrays double.
    for (const int count : {1, 2, 1025, 8193}) {
      std::string text = "[";
      for (int i = 0; i < count; ++i) text += (i == 0 ? "" : ",") + std::string(item);
      text += "]";
      expect_bounded<nlohmann::json>(text);
      expect_bounded<nlohmann::ordered_json>(text);
      expect_bounded<GltfJson>(text);
      expect_bounded<GltfJson>("{\"a\":" + text + ",\"b\":0,\"c\":0,\"d\":0,\"e\":0}");
    }
  }
}

// The stream has 3 kB.
TEST(JsonMemory, OfAnAssetIsKnownBeforeItIsRead) {
  std::string text = R"({"asset":{"version":"2.0"},"materials":[)";
  for (int i = 0; i < 300000; ++i) text += "[],";
  text += "0]}";
  const std::string glb = glb_head(text, 0);
  const std::uint64_t estimate = asset_memory_bytes(glb);
  EXPECT_GT(estimate, 20'000'000U);
  const std::size_t before = memory_count.now;
  memory_count.peak = before;
  const StreamAsset asset(glb);
  EXPECT_NE(asset.problem().find("materials[0]"), std::string::npos) << asset.problem();
  EXPECT_LE(memory_count.peak - before, estimate);
}

}  // namespace
}  // namespace rlpc
