// Streams in files, and from standard input.
#pragma once

#include <memory>
#include <string>

#include "common/result.h"
#include "decoder/stream/byte_source.h"

namespace rlpc {

// Reads from a file as needed; a pipe is read whole. Error: Errc::kIo, the element says why.
Result<std::unique_ptr<ByteSource>> file_source(const std::string& path);
// Reads standard input whole.
Result<std::unique_ptr<ByteSource>> standard_input_source();
// The one or, for "-", the other.
inline Result<std::unique_ptr<ByteSource>> file_or_standard_input(const std::string& path) {
  return path == "-" ? standard_input_source() : file_source(path);
}

}  // namespace rlpc
