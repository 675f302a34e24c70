// 7.10: whether metadata is a JSON text (RFC 8259) in UTF-8.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace rlpc {

// Offset of the first byte that makes the text invalid; none if it is valid.
//
// Note: the parser of a JSON library does not suffice. It stops at a zero byte, skips a byte
// order mark and refuses large numbers; RFC 8259 permits only the last.
std::optional<std::size_t> find_json_error(std::string_view text);

}  // namespace rlpc
