// The interface through which a decoder reads a stream.
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

  // Of a pipe: reads it to its end.
  virtual std::uint64_t size() const = 0;
  // Whether there are at least `end` bytes. Of a pipe: waits for them or for its end.
  virtual bool reaches(std::uint64_t end) { return end <= size(); }
  // Fills `out` from `offset`; false if the bytes are not there or cannot be read.
  virtual bool read(std::uint64_t offset, std::span<std::uint8_t> out) = 0;
  // Bytes before an offset will not be read again.
  virtual void forget(std::uint64_t /*before*/) {}
  // The memory it holds that counts towards the limits.
  virtual std::uint64_t memory_bytes() const { return 0; }
};

// A source that holds a copy of the bytes.
std::unique_ptr<ByteSource> memory_source(Vector<std::uint8_t> bytes);

}  // namespace rlpc
