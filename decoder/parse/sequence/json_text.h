// 7.10: whether metadata is a JSON text (RFC 8259) in UTF-8.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace rlpc {

// Offset of the first byte that no JSON text can have there, or nothing if all is well.
//
// Note: a parser of a JSON library will not do. They stop at a zero byte, skip a byte order
// mark and refuse large numbers, of which RFC 8259 allows only the last.
std::optional<std::size_t> find_json_error(std::string_view text);

}  // namespace rlpc
