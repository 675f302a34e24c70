// Memory that `new` takes, counted: for tests of how much that is. To be included by one source
// file of a program, whose operators new and delete it replaces.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

namespace rlpc {

struct MemoryCount {
  std::size_t now = 0;                                               // bytes
  std::size_t peak = 0;                                              // most bytes at a time
  std::size_t calls = 0;                                             // of new
  std::size_t calls_left = std::numeric_limits<std::size_t>::max();  // until new fails
};
inline MemoryCount memory_count;

namespace counting {

// The size stands before what is given.
inline constexpr std::size_t kBefore = alignof(std::max_align_t);

// Null if there is no memory.
inline void* take(std::size_t size) noexcept {
  if (memory_count.calls_left == 0) return nullptr;
  --memory_count.calls_left;
  auto* start = static_cast<std::byte*>(std::malloc(size + kBefore));
  if (start == nullptr) return nullptr;
  *reinterpret_cast<std::size_t*>(start) = size;
  ++memory_count.calls;
  memory_count.now += size;
  memory_count.peak = std::max(memory_count.peak, memory_count.now);
  return start + kBefore;
}

inline void* take_or_throw(std::size_t size) {
  void* place = take(size);
  if (place == nullptr) throw std::bad_alloc();
  return place;
}

inline void give_back(void* place) {
  if (place == nullptr) return;
  std::byte* start = static_cast<std::byte*>(place) - kBefore;
  memory_count.now -= *reinterpret_cast<std::size_t*>(start);
  std::free(start);
}

}  // namespace counting
}  // namespace rlpc

void* operator new(std::size_t size) { return rlpc::counting::take_or_throw(size); }
void* operator new[](std::size_t size) { return rlpc::counting::take_or_throw(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return rlpc::counting::take(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return rlpc::counting::take(size);
}
void operator delete(void* place) noexcept { rlpc::counting::give_back(place); }
void operator delete[](void* place) noexcept { rlpc::counting::give_back(place); }
void operator delete(void* place, std::size_t) noexcept { rlpc::counting::give_back(place); }
void operator delete[](void* place, std::size_t) noexcept { rlpc::counting::give_back(place); }
