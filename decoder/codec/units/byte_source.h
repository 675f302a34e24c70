// Interface through which a decoder reads a stream.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "common/memory/owned.h"

namespace rlpc {

class ByteSource : public Owned {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  // Returns the size in bytes. Reads a pipe to its end.
  virtual std::uint64_t size() const = 0;
  // Returns whether the size is at least `end` bytes. Waits for these bytes of a pipe, or for
  // its end.
  virtual bool reaches(std::uint64_t end) { return end <= size(); }
  // Fills `out` from `offset`; returns false if the bytes do not exist or cannot be read.
  virtual bool read(std::uint64_t offset, std::span<std::uint8_t> out) = 0;
  // Declares that bytes before an offset will not be read again.
  virtual void forget(std::uint64_t /*before*/) {}
  // Returns the memory it holds that counts towards the limits.
  virtual std::uint64_t memory_bytes() const { return 0; }
};

// Makes a source that holds the bytes.
std::unique_ptr<ByteSource> memory_source(Vector<std::uint8_t> bytes);

}  // namespace rlpc
