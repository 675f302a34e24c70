// Files that are written beside the one that the user named.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/io/output_file.h"

namespace rlpc {

// The error if `path` may not be replaced: since the user did not name it, only a file that
// rlpcdec wrote may be, which its beginning shows. what: "the mesh of a.pc2", for messages.
std::optional<OutputError> check_companion(const std::string& path, std::string_view begin,
                                           const std::string& what);

}  // namespace rlpc
