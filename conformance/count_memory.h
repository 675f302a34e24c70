// Memory that `new` takes, counted: for tests of how much that is. To be included by one source
// file of a program, whose operators new and delete it replaces.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace rlpc {

struct MemoryCount {
  std::size_t now = 0;    // bytes
  std::size_t peak = 0;   // most bytes at a time
  std::size_t calls = 0;  // of new
};
inline MemoryCount memory_count;

namespace counting {

// The size stands before what is given.
inline constexpr std::size_t kBefore = alignof(std::max_align_t);

inline void* take(std::size_t size) {
  auto* start = static_cast<std::byte*>(std::malloc(size + kBefore));
  if (start == nullptr) throw std::bad_alloc();
  *reinterpret_cast<std::size_t*>(start) = size;
  ++memory_count.calls;
  memory_count.now += size;
  memory_count.peak = std::max(memory_count.peak, memory_count.now);
  return start + kBefore;
}

inline void give_back(void* place) {
  if (place == nullptr) return;
  std::byte* start = static_cast<std::byte*>(place) - kBefore;
  memory_count.now -= *reinterpret_cast<std::size_t*>(start);
  std::free(start);
}

}  // namespace counting
}  // namespace rlpc

void* operator new(std::size_t size) { return rlpc::counting::take(size); }
void* operator new[](std::size_t size) { return rlpc::counting::take(size); }
void operator delete(void* place) noexcept { rlpc::counting::give_back(place); }
void operator delete[](void* place) noexcept { rlpc::counting::give_back(place); }
void operator delete(void* place, std::size_t) noexcept { rlpc::counting::give_back(place); }
void operator delete[](void* place, std::size_t) noexcept { rlpc::counting::give_back(place); }
