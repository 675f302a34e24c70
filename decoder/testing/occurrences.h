// Counts words in a text, for tests of what is written.
#pragma once

#include <cstddef>
#include <string>

namespace rlpc {

inline std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) ++found;
  return found;
}

}  // namespace rlpc
