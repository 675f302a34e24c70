// Tests the validator's texts about its findings, and its check that metadata is JSON.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/json/json_text.h"
#include "conformance/rlpcval/rule_explanations.h"

namespace rlpc {
namespace {

TEST(Explanations, OfExactlyTheRulesThatThereAre) {
  std::ifstream file(RLPC_SOURCE_DIR "/spec/rules.json");
  const nlohmann::json rules = nlohmann::json::parse(file);
  const auto table = rule_explanations();
  ASSERT_EQ(table.size(), rules.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    EXPECT_EQ(table[i].id, rules[i]["rule"].get<std::string>());
    EXPECT_EQ(table[i].clause, rules[i]["clause"].get<std::string>()) << table[i].id;
  }
}

TEST(Explanations, SaySomething) {
  for (const auto table : {rule_explanations(), warning_explanations()}) {
    for (const RuleExplanation& e : table) {
      EXPECT_EQ(explain(e.id), &e) << e.id << " is there twice";
      for (const std::string_view text : {e.explanation, e.cause, e.remedy}) {
        EXPECT_GT(text.size(), 10U) << e.id;
        EXPECT_EQ(text.back(), '.') << e.id;
      }
    }
  }
  EXPECT_EQ(explain("R-XYZ-99"), nullptr);
}

TEST(Json, TextsOfRfc8259) {
  for (const std::string_view text :
       {"0", " -0.5e+7 ", "1e999", "\"\"", "[]", "{}", "[[],{}]", R"({"a":[1,2,{"b":null}]})",
        R"("\ud800\u00e4\n\/")", "\"\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80\"", "\ttrue\r\n",
        "{\"a\":1,\"a\":2}"}) {
    EXPECT_EQ(find_json_error(text), std::nullopt) << text;
  }
}

TEST(Json, TextsThatAreNotJson) {
  using namespace std::string_view_literals;
  for (const auto& [text, at] :
       std::vector<std::pair<std::string_view, std::size_t>>{{"", 0},
                                                             {"  ", 2},
                                                             {"{}\0"sv, 2},
                                                             {"\xEF\xBB\xBF{}", 0},
                                                             {"[1,]", 3},
                                                             {"[1 2]", 3},
                                                             {"{\"a\"}", 4},
                                                             {"{1:2}", 1},
                                                             {"{\"a\":1,}", 7},
                                                             {"01", 1},
                                                             {"1.", 2},
                                                             {".5", 0},
                                                             {"+1", 0},
                                                             {"1e", 2},
                                                             {"nul", 3},
                                                             {"True", 0},
                                                             {"'a'", 0},
                                                             {"\"a", 2},
                                                             {"\"\t\"", 1},
                                                             {"\"\\x\"", 2},
                                                             {"\"\\u12g4\"", 5},
                                                             {"\"\xC3\"", 2},
                                                             {"\"\xC0\x80\"", 1},
                                                             {"\"\xE4\"", 2},
                                                             {"\"\xED\xA0\x80\"", 2},
                                                             {"\"\xF4\x90\x80\x80\"", 2},
                                                             {"[}", 1},
                                                             {"[1}", 2},
                                                             {"1 1", 2},
                                                             {"NaN", 0},
                                                             {"// a\n1", 0},
                                                             {"[", 1}}) {
    const auto found = find_json_error(text);
    ASSERT_TRUE(found) << text;
    EXPECT_EQ(*found, at) << text;
  }
}

// Nests as deep as a metadata unit can.
TEST(Json, NestsWithoutEnd) {
  const std::string deep(1 << 20, '[');
  EXPECT_EQ(find_json_error(deep), deep.size());
  EXPECT_EQ(find_json_error(deep + std::string(deep.size(), ']')), std::nullopt);
}

}  // namespace
}  // namespace rlpc
