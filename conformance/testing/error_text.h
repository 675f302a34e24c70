// Errors of parsers as text, for tests.
#pragma once

#include <optional>
#include <string>

#include "common/result.h"

namespace rlpc {

// Returns the rule and the element, or "no error".
inline std::string text_of(const std::optional<Error>& error) {
  return error ? std::string(error->rule) + " " + error->element : "no error";
}

}  // namespace rlpc
