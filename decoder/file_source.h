// Streams in files, and from standard input.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/result.h"
#include "decoder/stream/byte_source.h"

namespace rlpc {

// That of DecodeLimits, if nobody says otherwise.
inline constexpr std::uint64_t kUsualMemoryBytes = std::uint64_t{1} << 32;

// Reads from a file as needed. A pipe or a device is read whole, and kept, unless it does not
// begin like a stream: then nothing behind that is read. Errors: Errc::kIo, the element says
// why; Errc::kLimitExceeded: there is more to keep than max_memory_bytes.
Result<std::unique_ptr<ByteSource>> file_source(
    const std::string& path, std::uint64_t max_memory_bytes = kUsualMemoryBytes);
// Standard input, likewise.
Result<std::unique_ptr<ByteSource>> standard_input_source(
    std::uint64_t max_memory_bytes = kUsualMemoryBytes);
// The one or, for "-", the other.
inline Result<std::unique_ptr<ByteSource>> file_or_standard_input(
    const std::string& path, std::uint64_t max_memory_bytes = kUsualMemoryBytes) {
  return path == "-" ? standard_input_source(max_memory_bytes)
                     : file_source(path, max_memory_bytes);
}

}  // namespace rlpc
