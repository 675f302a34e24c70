#ifdef RLPC_OWNED_MEMORY

#include "common/memory/owned.h"

#include <algorithm>
#include <cstring>
#include <new>
#include <utility>

namespace rlpc {
namespace {

constinit thread_local const Owner* owner_of_thread = nullptr;

constexpr std::size_t kOwnerBytes = sizeof(const Owner*);  // NOLINT(bugprone-sizeof-expression)

// Returns the bytes before a block, which store its owner.
std::size_t bytes_before(std::size_t alignment) {
  return std::max(alignment, alignof(std::max_align_t));
}

}  // namespace

const Owner* current_owner() { return owner_of_thread; }

OwnerScope::OwnerScope(const Owner* owner) : before_(std::exchange(owner_of_thread, owner)) {}
OwnerScope::~OwnerScope() { owner_of_thread = before_; }

void* allocate_owned(std::size_t size, std::size_t alignment) {
  const Owner* const owner = owner_of_thread;
  const std::size_t before = bytes_before(alignment);
  void* start = nullptr;
  if (owner == nullptr) {
    start = ::operator new (size + before, std::align_val_t{before});
  } else {
    start = owner->allocate(owner->user, size + before, before);
    if (start == nullptr) throw std::bad_alloc();
  }
  std::memcpy(start, &owner, kOwnerBytes);
  return static_cast<std::byte*>(start) + before;
}

void release_owned(void* place, std::size_t size, std::size_t alignment) noexcept {
  if (place == nullptr) return;
  const std::size_t before = bytes_before(alignment);
  void* const start = static_cast<std::byte*>(place) - before;
  const Owner* owner = nullptr;
  std::memcpy(&owner, start, kOwnerBytes);
  if (owner == nullptr) {
    ::operator delete (start, std::align_val_t{before});
  } else {
    owner->release(owner->user, start, size + before, before);
  }
}

}  // namespace rlpc

#endif
