// Counts the memory that `new` allocates, for tests. count_memory.cpp replaces the operators
// new and delete of the program that it is linked into.
#pragma once

#include <cstddef>
#include <limits>

namespace rlpc {

struct MemoryCount {
  std::size_t now = 0;                                               // bytes
  std::size_t peak = 0;                                              // most bytes at a time
  std::size_t calls = 0;                                             // calls of new
  std::size_t calls_left = std::numeric_limits<std::size_t>::max();  // calls until new fails
  bool fails_once = false;   // only that call fails; else all later ones too
  std::size_t failures = 0;  // calls that failed
};
extern MemoryCount memory_count;

}  // namespace rlpc
