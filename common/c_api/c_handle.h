// Memory, errors and containment of exceptions of the handles of the C API.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string_view>

#include "common/c_api/rlpc_status.h"
#include "common/memory/owned.h"

namespace rlpc {

// Last error of a handle, in a fixed buffer that needs no memory.
class HandleError {
 public:
  // Sets the text, cut off at the size of the buffer, and returns the status.
  rlpc_status set(rlpc_status status, std::string_view text) {
    text_[text.copy(text_.data(), text_.size() - 1)] = '\0';
    return status;
  }
  // Sets a sticky error: the handle becomes unusable.
  rlpc_status break_handle(rlpc_status status, std::string_view text) {
    broken_ = status;
    return set(status, text);
  }
  void clear() { text_[0] = '\0'; }
  rlpc_status broken() const { return broken_; }  // RLPC_OK: the handle is usable
  const char* text() const { return text_.data(); }

 private:
  std::array<char, 512> text_{};
  rlpc_status broken_ = RLPC_OK;
};

// Returns the owner of the memory that calls on the handle allocate: its member `owner`, or
// null if it has none or it is not set.
template <class Handle>
const Owner* owner_of(const Handle& handle) {
  if constexpr (requires { handle.owner; }) {
    if (handle.owner.allocate != nullptr) return &handle.owner;
  }
  return nullptr;
}

// Returns the status that `call` returns, or converts its exceptions to a sticky error. Handle
// has a member HandleError error.
template <class Handle, class Call>
rlpc_status guarded(Handle* handle, const Call& call) noexcept {
  if (handle == nullptr) return RLPC_BAD_ARGUMENT;
  if (handle->error.broken() != RLPC_OK) return handle->error.broken();
  const OwnerScope scope(owner_of(*handle));
  try {
    return call();
  } catch (const std::bad_alloc&) {
    return handle->error.break_handle(RLPC_OUT_OF_MEMORY, "out of memory");
  } catch (const std::length_error&) {
    return handle->error.break_handle(RLPC_OUT_OF_MEMORY, "out of memory");
  } catch (const std::exception& error) {
    return handle->error.break_handle(RLPC_INTERNAL_ERROR, error.what());
  } catch (...) {
    return handle->error.break_handle(RLPC_INTERNAL_ERROR, "internal error");
  }
}

// Makes a handle, at `place` unless that is null. Returns null if `place` is too small or not
// aligned, or if there is no memory. Handle has a member bool is_placed.
template <class Handle>
Handle* make_handle(void* place, std::size_t place_bytes) noexcept {
  static_assert(alignof(Handle) <= alignof(std::max_align_t));
  if (place == nullptr) return new (std::nothrow) Handle();
  const auto address = reinterpret_cast<std::uintptr_t>(place);
  if (place_bytes < sizeof(Handle) || address % alignof(Handle) != 0) return nullptr;
  auto* handle = new (place) Handle();
  handle->is_placed = true;
  return handle;
}

// Destroys a handle of make_handle(). Null: does nothing.
template <class Handle>
void close_handle(Handle* handle) noexcept {
  if (handle == nullptr) return;
  if (handle->is_placed) {
    std::destroy_at(handle);
  } else {
    delete handle;
  }
}

// Copies a structure to the caller. Structures of the API begin with struct_size, their size in
// the version of the caller, which may be older or newer; members that are unknown here are
// set to 0.
template <class T>
void give_struct(const T& ours, T* theirs, std::size_t struct_size) {
  if (theirs == nullptr || struct_size < sizeof(std::size_t)) return;
  std::memset(theirs, 0, struct_size);
  std::memcpy(theirs, &ours, std::min(struct_size, sizeof(T)));
  theirs->struct_size = struct_size;
}

// Reads a structure of the caller; `ours` holds the defaults, which stay for members that the
// caller does not know. Returns false if it is not initialised, or if members that this version
// does not know are set.
template <class T>
bool take_struct(const T* theirs, T& ours) {
  constexpr std::size_t kMaxBytes = 4096;
  if (theirs == nullptr) return true;
  const std::size_t size = theirs->struct_size;
  if (size < sizeof(std::size_t) || size > kMaxBytes) return false;
  const auto* bytes = reinterpret_cast<const unsigned char*>(theirs);
  if (size > sizeof(T) && std::any_of(bytes + sizeof(T), bytes + size,
                                      [](unsigned char byte) { return byte != 0; })) {
    return false;
  }
  std::memcpy(&ours, theirs, std::min(size, sizeof(T)));
  return true;
}

}  // namespace rlpc
