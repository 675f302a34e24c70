// Checks JSON texts (RFC 8259) before they are parsed: their validity, and the size of the tree
// of a parser. No other code scans JSON, and none parses it without this (json.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rlpc {

// Maximum nesting of arrays and objects. Functions that copy, compare and write trees are
// recursive; deeper trees would overflow the stack.
inline constexpr std::size_t kMaxJsonDepth = 100;

// Returns the offset of the first byte that makes the text invalid; none if it is valid UTF-8
// and JSON, nested to any depth. Cost: linear in the text; a byte of memory per level.
//
// Note: the parser of the JSON library does not suffice. It stops at a zero byte, skips a byte
// order mark and rejects large numbers; RFC 8259 permits only the last.
std::optional<std::size_t> find_json_error(std::string_view text);

// Size of the tree of a text.
struct JsonShape {
  std::uint64_t members = 0;      // members of all objects
  std::uint64_t elements = 0;     // elements of all arrays
  std::uint64_t blocks = 0;       // values with separate memory: strings, arrays, objects
  std::uint64_t levels = 0;       // sum of the depths of all members and elements
  std::uint64_t comparisons = 0;  // comparisons of names if each member of an object is
                                  // compared with all before it; long names count several times
};

struct JsonFault {
  bool too_deep = false;     // true: deeper than kMaxJsonDepth; false: not JSON
  std::size_t position = 0;  // first byte of the fault
};
// Measures a text. Returns the first fault, or none and sets the shape. Cost: linear in the
// text; allocates nothing.
std::optional<JsonFault> measure_json(std::string_view text, JsonShape& shape);

// Returns an upper bound of the bytes that a tree of nlohmann's library takes while it grows,
// and while it is printed with an indent of up to 2.
std::uint64_t json_tree_bytes(const JsonShape& shape, std::size_t text_bytes);

// Reason why a text was not read.
struct JsonProblem {
  enum Kind : std::uint8_t { kInvalid, kTooDeep, kTooWide, kTooLarge };
  Kind kind = kInvalid;
  std::string message;             // "line 2, column 7: expected JSON"
  std::uint64_t needed_bytes = 0;  // kTooLarge: memory
};

// Returns the place of a byte of a text: "line 2, column 7"; columns are bytes.
std::string json_place(std::string_view text, std::size_t position);

// Returns the problem of a text for a parser: invalid, nested too deeply, larger than max_bytes
// as a tree, or with too many members in objects that compare each name with all others
// (has_lists: as ordered_map does). Cost: linear in the text.
std::optional<JsonProblem> find_json_problem(std::string_view text, std::uint64_t max_bytes,
                                             bool has_lists);

}  // namespace rlpc
