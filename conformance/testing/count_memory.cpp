#include "conformance/testing/count_memory.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <new>

namespace rlpc {

MemoryCount memory_count;

namespace {

std::mutex counting;

// The size is stored before the returned block.
constexpr std::size_t kBefore = alignof(std::max_align_t);

// Allocates memory; null if there is none.
void* take(std::size_t size) noexcept {
  const std::lock_guard<std::mutex> lock(counting);
  if (memory_count.calls_left == 0) {
    ++memory_count.failures;
    if (memory_count.fails_once)
      memory_count.calls_left = std::numeric_limits<std::size_t>::max();
    return nullptr;
  }
  --memory_count.calls_left;
  auto* start = static_cast<std::byte*>(std::malloc(size + kBefore));
  if (start == nullptr) return nullptr;
  *reinterpret_cast<std::size_t*>(start) = size;
  ++memory_count.calls;
  memory_count.now += size;
  memory_count.peak = std::max(memory_count.peak, memory_count.now);
  return start + kBefore;
}

void* take_or_throw(std::size_t size) {
  void* place = take(size);
  if (place == nullptr) throw std::bad_alloc();
  return place;
}

void give_back(void* place) noexcept {
  if (place == nullptr) return;
  const std::lock_guard<std::mutex> lock(counting);
  std::byte* start = static_cast<std::byte*>(place) - kBefore;
  memory_count.now -= *reinterpret_cast<std::size_t*>(start);
  std::free(start);
}

}  // namespace
}  // namespace rlpc

void* operator new(std::size_t size) { return rlpc::take_or_throw(size); }
void* operator new[](std::size_t size) { return rlpc::take_or_throw(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return rlpc::take(size);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return rlpc::take(size);
}
void operator delete(void* place) noexcept { rlpc::give_back(place); }
void operator delete[](void* place) noexcept { rlpc::give_back(place); }
void operator delete(void* place, std::size_t) noexcept { rlpc::give_back(place); }
void operator delete[](void* place, std::size_t) noexcept { rlpc::give_back(place); }
