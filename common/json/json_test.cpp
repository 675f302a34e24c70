// Tests which texts are read, and why others are rejected.
#include "common/json/json.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>

#include "common/testing/random_json.h"

namespace rlpc {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::string nested(std::size_t depth, const std::string& open, const std::string& close) {
  std::string text;
  for (std::size_t d = 0; d < depth; ++d) text += open;
  text += "0";
  for (std::size_t d = 0; d < depth; ++d) text += close;
  return text;
}

template <class Json = ordered_json>
std::optional<JsonProblem> problem_of(const std::string& text,
                                      std::uint64_t max_bytes = UINT64_MAX) {
  JsonProblem problem;
  if (read_json<Json>(text, max_bytes, problem)) return std::nullopt;
  return problem;
}

TEST(ReadJson, RefusesTextsThatAreNestedTooDeeply) {
  for (const auto& [open, close] : {std::pair("[", "]"), std::pair("{\"a\":", "}")}) {
    EXPECT_FALSE(problem_of(nested(kMaxJsonDepth, open, close)));
    for (const std::size_t depth :
         {kMaxJsonDepth + 1, std::size_t{20000}, std::size_t{1000000}}) {
      const auto problem = problem_of(nested(depth, open, close));
      ASSERT_TRUE(problem);
      EXPECT_EQ(problem->kind, JsonProblem::kTooDeep);
      const std::size_t column = kMaxJsonDepth * std::string(open).size() + 1;
      EXPECT_EQ(problem->message, "line 1, column " + std::to_string(column) +
                                      ": arrays and objects nested more than 100 levels deep");
    }
  }
}

TEST(ReadJson, MetadataMayBeNestedToAnyDepth) {
  const std::string text = nested(500000, "[", "]");
  EXPECT_EQ(find_json_error(text), std::nullopt);
  EXPECT_EQ(find_json_error(text + "]"), text.size());
}

TEST(ReadJson, RefusesObjectsThatWouldTakeTimeByTheSquareOfTheirMembers) {
  std::string text = "{\"0\":0";
  for (int i = 1; i < 40000; ++i) text += ",\"" + std::to_string(i) + "\":0";
  text += "}";
  ASSERT_TRUE(problem_of(text));
  EXPECT_EQ(problem_of(text)->kind, JsonProblem::kTooWide);
  EXPECT_FALSE(problem_of<json>(text));  // which sorts them
  std::string many = "[0";
  for (int i = 0; i < 100000; ++i) many += R"(,{"a":0,"b":1,"c":2,"d":3,"e":4})";
  EXPECT_FALSE(problem_of(many + "]"));
}

TEST(ReadJson, LongNamesCountSeveralTimes) {
  const std::string begin(20000, 'a');
  std::string text = "{\"" + begin + "\":0";
  for (int i = 0; i < 1000; ++i) text += ",\"" + begin + std::to_string(i) + "\":0";
  JsonShape shape;
  ASSERT_FALSE(measure_json(text + "}", shape));
  EXPECT_EQ(shape.members, 1001U);
  EXPECT_GT(shape.comparisons, 500U * 1000U * 600U);
}

TEST(ReadJson, RefusesTreesThatAreTooLarge) {
  std::string text = "[[]";
  for (int i = 0; i < 1000; ++i) text += ",[]";
  text += "]";
  const auto problem = problem_of(text, 100000);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->kind, JsonProblem::kTooLarge);
  EXPECT_GT(problem->needed_bytes, 100000U);
  EXPECT_FALSE(problem_of(text, problem->needed_bytes));
  EXPECT_TRUE(problem_of(text, problem->needed_bytes - 1));
}

TEST(ReadJson, TellsWhereATextIsWrong) {
  EXPECT_EQ(problem_of("{\n \"a\": 1,\n}")->message, "line 3, column 1: not JSON in UTF-8");
  EXPECT_EQ(problem_of("[1")->message, "line 1, column 3: JSON that ends too early");
  EXPECT_EQ(problem_of("\"\xFF\"")->message, "line 1, column 2: not JSON in UTF-8");
  EXPECT_EQ(problem_of("")->kind, JsonProblem::kInvalid);
  const std::string refused = ": a number too large for a float, or half a surrogate pair";
  for (const char* const text : {"1e999", R"("\ud800")"}) {
    EXPECT_EQ(problem_of(text)->message, "line 1, column 1" + refused);
    const std::string inside = std::string("{\n \"a\": [1, \"\\n\", ") + text + "]}";
    EXPECT_EQ(problem_of(inside)->message, "line 2, column 17" + refused);
  }
}

TEST(ReadJson, SkipsAByteOrderMarkAndZeros) {
  using namespace std::string_literals;
  EXPECT_FALSE(problem_of("\xEF\xBB\xBF[1]"));
  EXPECT_FALSE(problem_of("[1]\0\0"s));
  EXPECT_TRUE(problem_of("[1]\0[2]"s));
}

TEST(WriteJson, ReplacesWhatIsNotUtf8) {
  EXPECT_EQ(json_text(json("a\xFFz")), "\"a\xEF\xBF\xBDz\"");
  EXPECT_EQ(json_text(json("\xC3\xA4"), -1, true), "\"\\u00e4\"");
}

// Counts the parts of a tree. Repeated names occur once.
void count(const json& value, std::uint64_t depth, JsonShape& shape) {
  if (value.is_string() || value.is_structured()) ++shape.blocks;
  (value.is_object() ? shape.members : shape.elements) +=
      value.is_structured() ? value.size() : 0;
  for (const json& member : value) {
    if (!value.is_structured()) break;
    shape.levels += depth + 1;
    count(member, depth + 1, shape);
  }
}

TEST(MeasureJson, CountsWhatATreeHas) {
  constexpr std::uint32_t kSeed = 4801;
  std::size_t compared = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const std::string text = RandomJson(kSeed + i).text(3000, 30);
    JsonShape shape;
    ASSERT_FALSE(measure_json(text, shape)) << i << ": " << text;
    const json tree = json::parse(text);
    JsonShape expected;
    count(tree, 0, expected);
    EXPECT_GE(shape.members, expected.members) << i;
    if (shape.members != expected.members) continue;  // names are repeated
    EXPECT_EQ(shape.elements, expected.elements) << i;
    EXPECT_EQ(shape.blocks, expected.blocks) << i;
    EXPECT_EQ(shape.levels, expected.levels) << i;
    ++compared;
  }
  EXPECT_GT(compared, 100U);
}

TEST(MeasureJson, AgreesWithAParserOnDamagedTexts) {
  constexpr std::uint32_t kSeed = 4802;
  std::mt19937 random(kSeed);
  int num_valid = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    std::string text = RandomJson(kSeed + i).text(60, 10);
    for (int n = 0; n < 2; ++n) {
      text[random() % text.size()] = "[]{},:\"\\0ae-\x80\xC3"[random() % 14];
    }
    const bool is_valid = json::accept(text);
    if (is_valid) ++num_valid;
    const bool is_read = !problem_of<json>(text);
    EXPECT_EQ(is_read, is_valid) << text;
  }
  EXPECT_GT(num_valid, 100);
  EXPECT_LT(num_valid, 2900);
}

}  // namespace
}  // namespace rlpc
