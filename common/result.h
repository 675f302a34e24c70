// Errors and results. Bad streams and files yield an Error; caller errors are asserted.
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>
#include <utility>

namespace rlpc {

enum class Errc : std::uint8_t {
  kTruncated,      // bits ran out inside a syntax structure
  kInvalid,        // a requirement of bitstream conformance is broken
  kUnsupported,    // legal, but outside the version, profile or level of this decoder
  kLimitExceeded,  // legal, but beyond the caller's DecodeLimits
  kIo,             // the stream could not be read
};

// Error of a stream or file. Trivially copyable: reporting a failure never allocates. Both
// strings are literals.
struct Error {
  Errc code = Errc::kInvalid;
  const char* rule = "";           // rule id of the specification, for example "R-HDR-03"
  const char* element = "";        // syntax element, spelled as in the specification
  std::uint64_t bit_pos = 0;       // start of that element, or near it (spec/permissive.md)
  std::uint64_t needed_bytes = 0;  // lower bound of the memory needed; 0: unknown or no limit
};

template <class T, class E = Error>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}  // NOLINT(google-explicit-constructor)
  Result(E error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)
  explicit operator bool() const { return value_.has_value(); }
  T& operator*() {
    assert(value_);
    return *value_;
  }
  const T& operator*() const {
    assert(value_);
    return *value_;
  }
  T* operator->() {
    assert(value_);
    return &*value_;
  }
  const T* operator->() const {
    assert(value_);
    return &*value_;
  }
  const E& error() const {
    assert(!value_);
    return error_;
  }

 private:
  std::optional<T> value_;
  E error_{};
};

}  // namespace rlpc
