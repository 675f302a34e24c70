// Reads and writes JSON: the only calls of the JSON library that parse or print. Texts are
// untrusted.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "common/json/json_text.h"

namespace rlpc {

// Finds the place at which the parser rejects a text.
template <class Json>
class JsonRefusal : public nlohmann::json_sax<Json> {
 public:
  using typename nlohmann::json_sax<Json>::number_integer_t;
  using typename nlohmann::json_sax<Json>::number_unsigned_t;
  using typename nlohmann::json_sax<Json>::number_float_t;
  using typename nlohmann::json_sax<Json>::string_t;
  using typename nlohmann::json_sax<Json>::binary_t;

  // Returns the first byte of the token that the parser rejects.
  std::size_t position() const { return position_; }

  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(number_integer_t /*value*/) override { return true; }
  bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override {
    return true;
  }
  bool string(string_t& /*value*/) override { return true; }
  bool binary(binary_t& /*value*/) override { return true; }
  bool start_object(std::size_t /*size*/) override { return true; }
  bool key(string_t& /*value*/) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t /*size*/) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t end, const std::string& token,
                   const nlohmann::detail::exception& /*why*/) override {
    position_ = end - std::min(end, token.size());
    return false;
  }

 private:
  std::size_t position_ = 0;
};

// Reads a text; none if there is a problem. Skips a byte order mark before it and zero bytes
// after it. max_bytes: memory for the tree (json_tree_bytes()). Cost: linear in the text, times
// the logarithm of their number for names of members.
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
  JsonRefusal<Json> refusal;
  Json::sax_parse(text.begin(), text.end(), &refusal);
  problem = {JsonProblem::kInvalid,
             json_place(text, refusal.position()) +
                 ": a number too large for a float, or half a surrogate pair"};
  return std::nullopt;
}

// Returns the text of a value; invalid UTF-8 in strings is replaced. indent: spaces per level;
// -1: one line. ascii: escapes all other characters.
template <class Json>
std::string json_text(const Json& json, int indent = -1, bool ascii = false) {
  return json.dump(indent, ' ', ascii, Json::error_handler_t::replace);
}

}  // namespace rlpc
