// Reads and writes JSON: the only calls of the JSON library that parse or print. Nothing of a
// text is trusted.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "common/json/json_text.h"

namespace rlpc {

// Reads a text; max_bytes: of memory for the tree (json_tree_bytes()). A byte order mark before
// it and zero bytes behind it are skipped. Returns none if there is a problem. Cost: linear in
// the text and, for names of members, in the logarithm of their number.
template <class Json>
std::optional<Json> read_json(std::string_view text, std::uint64_t max_bytes,
                              JsonProblem& problem) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  text = text.substr(0, text.find_last_not_of('\0') + 1);
  constexpr bool kHasLists = requires { typename Json::object_t::Container; };
  if (auto found = find_json_problem(text, max_bytes, kHasLists)) {
    problem = *std::move(found);
    return std::nullopt;
  }
  Json json = Json::parse(text.begin(), text.end(), nullptr, false);
  if (!json.is_discarded()) return json;
  problem = {JsonProblem::kInvalid,
             "has a number too large for a float, or half a surrogate pair"};
  return std::nullopt;
}

// Returns the text of a value; invalid UTF-8 in strings is replaced. indent: of a level; -1: on
// one line. ascii: escapes all other characters.
template <class Json>
std::string json_text(const Json& json, int indent = -1, bool ascii = false) {
  return json.dump(indent, ' ', ascii, Json::error_handler_t::replace);
}

}  // namespace rlpc
