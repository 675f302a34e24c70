#include <algorithm>
#include <string>

#include "common/json/json_text.h"

namespace rlpc {
namespace {

// Returns a bound of the time for members of objects: about a second, and more for long texts.
std::uint64_t max_comparisons(std::string_view text) {
  constexpr std::uint64_t kTextCost = 100'000'000;
  constexpr std::uint64_t kByteCost = 64;
  return kTextCost + kByteCost * text.size();
}

}  // namespace

std::string json_place(std::string_view text, std::size_t position) {
  const std::string_view before = text.substr(0, position);
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t line_end = before.rfind('\n');
  const std::size_t column = line_end == before.npos ? position : position - line_end - 1;
  return "line " + std::to_string(lines + 1) + ", column " + std::to_string(column + 1);
}

std::optional<JsonProblem> find_json_problem(std::string_view text, std::uint64_t max_bytes,
                                             bool has_lists) {
  JsonShape shape;
  if (const auto fault = measure_json(text, shape)) {
    const std::string place = json_place(text, fault->position) + ": ";
    if (!fault->too_deep) {
      const bool at_end = fault->position >= text.size();
      return JsonProblem{JsonProblem::kInvalid,
                         place + (at_end ? "JSON that ends too early" : "not JSON in UTF-8")};
    }
    return JsonProblem{JsonProblem::kTooDeep, place + "arrays and objects nested more than " +
                                                  std::to_string(kMaxJsonDepth) +
                                                  " levels deep"};
  }
  if (has_lists && shape.comparisons > max_comparisons(text)) {
    return JsonProblem{JsonProblem::kTooWide, "too many members in one object"};
  }
  const std::uint64_t needed = json_tree_bytes(shape, text.size());
  if (needed <= max_bytes) return std::nullopt;
  return JsonProblem{JsonProblem::kTooLarge,
                     "needs about " + std::to_string(needed) + " bytes of memory as a tree",
                     needed};
}

}  // namespace rlpc
