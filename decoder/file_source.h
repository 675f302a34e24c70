// Byte sources for files and standard input.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/result.h"
#include "decoder/codec/options.h"
#include "decoder/codec/units/byte_source.h"

namespace rlpc {

// Reads from a file as needed. A pipe or a device is buffered: of a stream of version 1.2, what
// has been needed so far; others are read to their end, unless their beginning shows that they
// are no streams. Errors: Errc::kIo, whose element holds the reason; Errc::kLimitExceeded: more
// than max_memory_bytes to buffer.
Result<std::unique_ptr<ByteSource>> file_source(
    const std::string& path, std::uint64_t max_memory_bytes = kUsualMemoryBytes);
// Opens standard input in the same way.
Result<std::unique_ptr<ByteSource>> standard_input_source(
    std::uint64_t max_memory_bytes = kUsualMemoryBytes);
// Opens standard input for "-", otherwise the file.
inline Result<std::unique_ptr<ByteSource>> file_or_standard_input(
    const std::string& path, std::uint64_t max_memory_bytes = kUsualMemoryBytes) {
  return path == "-" ? standard_input_source(max_memory_bytes)
                     : file_source(path, max_memory_bytes);
}

}  // namespace rlpc
