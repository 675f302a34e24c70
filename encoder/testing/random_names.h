// Random numbers for names of files, the same on every machine, for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace rlpc {

using Names = std::vector<std::string>;
using Random = std::mt19937;

inline std::uint32_t below(Random& random, std::size_t count) {
  return static_cast<std::uint32_t>(random() % count);
}

}  // namespace rlpc
