// Where a decoder reads from.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/result.h"

namespace rlpc {

class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  virtual std::uint64_t size() const = 0;
  // Fills `out` from `offset`; false if the bytes are not there or cannot be read.
  virtual bool read(std::uint64_t offset, std::span<std::uint8_t> out) = 0;
};

// Keeps a copy of the bytes.
std::unique_ptr<ByteSource> memory_source(std::vector<std::uint8_t> bytes);

// Reads from a file as needed; a pipe is read whole. Error: Errc::kIo, the element says why.
Result<std::unique_ptr<ByteSource>> file_source(const std::string& path);
// Reads standard input whole.
Result<std::unique_ptr<ByteSource>> standard_input_source();
// For messages.
inline std::string name_of_input(const std::string& path) {
  return path == "-" ? "standard input" : path;
}
// The one or, for "-", the other.
inline Result<std::unique_ptr<ByteSource>> file_or_standard_input(const std::string& path) {
  return path == "-" ? standard_input_source() : file_source(path);
}

}  // namespace rlpc
