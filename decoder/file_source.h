// Byte sources for files and standard input.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/result.h"
#include "decoder/codec/options.h"
#include "decoder/codec/units/byte_source.h"

namespace rlpc {

// Opens a file, which is read as needed. A pipe or device is buffered: as far as needed if it
// holds a stream of version 1.2, otherwise to its end, unless its beginning shows that it is no
// stream. Errors: Errc::kIo, whose element holds the reason; Errc::kLimitExceeded if the buffer
// exceeds max_memory_bytes.
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
