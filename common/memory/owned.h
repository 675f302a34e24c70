// Containers and objects whose memory comes from an owner. In the C library of the decoder
// (RLPC_OWNED_MEMORY), the owner is the callbacks of the handle in use; elsewhere, containers
// are those of the standard library.
//
// The allocator has no state. Each block records its owner, so that any thread can release it
// within any call; a new block gets the owner of the thread. The C functions set it during a
// call, and threads that work for them inherit it.
#pragma once

#include <cstddef>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace rlpc {

struct Owner {
  void* user = nullptr;
  void* (*allocate)(void* user, std::size_t size, std::size_t alignment) = nullptr;
  void (*release)(void* user, void* place, std::size_t size, std::size_t alignment) = nullptr;
};

#ifdef RLPC_OWNED_MEMORY

// Returns the owner of the thread; null: memory comes from operator new.
const Owner* current_owner();

// Sets the owner of the thread during its lifetime.
class OwnerScope {
 public:
  explicit OwnerScope(const Owner* owner);
  ~OwnerScope();
  OwnerScope(const OwnerScope&) = delete;
  OwnerScope& operator=(const OwnerScope&) = delete;

 private:
  const Owner* before_;
};

// Throws std::bad_alloc.
void* allocate_owned(std::size_t size, std::size_t alignment);
void release_owned(void* place, std::size_t size, std::size_t alignment) noexcept;

template <class T>
struct OwnedAllocator {
  using value_type = T;  // NOLINT(readability-identifier-naming): name of the standard
  OwnedAllocator() = default;
  template <class U>
  OwnedAllocator(const OwnedAllocator<U>&) {}  // NOLINT(google-explicit-constructor): converts
  T* allocate(std::size_t count) {
    if (count > static_cast<std::size_t>(-1) / 2 / kSize) return too_many();
    return static_cast<T*>(allocate_owned(count * kSize, alignof(T)));
  }
  void deallocate(T* place, std::size_t count) noexcept {
    release_owned(place, count * kSize, alignof(T));
  }
  bool operator==(const OwnedAllocator&) const { return true; }

 private:
  static constexpr std::size_t kSize = sizeof(T);  // NOLINT(bugprone-sizeof-expression)
  static T* too_many() {
    return static_cast<T*>(allocate_owned(static_cast<std::size_t>(-1) / 2, alignof(T)));
  }
};

// Base of objects that std::make_unique makes.
struct Owned {
  static void* operator new(std::size_t size) {
    return allocate_owned(size, alignof(std::max_align_t));
  }
  static void operator delete(void* place, std::size_t size) noexcept {
    release_owned(place, size, alignof(std::max_align_t));
  }
};

template <class T, class... Args>
std::shared_ptr<T> make_shared_owned(Args&&... args) {
  return std::allocate_shared<T>(OwnedAllocator<std::remove_const_t<T>>(),
                                 std::forward<Args>(args)...);
}

#else

inline const Owner* current_owner() { return nullptr; }
struct OwnerScope {
  explicit OwnerScope(const Owner* /*owner*/) {}
  ~OwnerScope() {}  // NOLINT(modernize-use-equals-default): a variable of it is used
};

template <class T>
using OwnedAllocator = std::allocator<T>;

struct Owned {};

template <class T, class... Args>
std::shared_ptr<T> make_shared_owned(Args&&... args) {
  return std::make_shared<T>(std::forward<Args>(args)...);
}

#endif

template <class T>
using Vector = std::vector<T, OwnedAllocator<T>>;
template <class Key, class T>
using Map = std::map<Key, T, std::less<Key>, OwnedAllocator<std::pair<const Key, T>>>;
template <class Key>
using Set = std::set<Key, std::less<Key>, OwnedAllocator<Key>>;
template <class T>
using LinkedList = std::list<T, OwnedAllocator<T>>;
using String = std::basic_string<char, std::char_traits<char>, OwnedAllocator<char>>;

}  // namespace rlpc
