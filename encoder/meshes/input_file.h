// Reads regular files and standard input ("-") at any offset, with errors that name the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/files/messages.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

class InputFile {
 public:
  // Opens a file. Standard input is read completely when first opened, up to max_memory_bytes,
  // and may be opened again. Errors: a file that cannot be read, or a Git LFS pointer in its
  // place.
  static InputResult<InputFile> open(const std::string& path,
                                     std::uint64_t max_memory_bytes = kUsualEncoderBytes);

  const std::string& path() const { return path_; }  // for messages: see name_of_input()
  std::uint64_t size() const { return size_; }
  // Returns the memory that the contents occupy.
  std::uint64_t memory_bytes() const { return stream_ ? 0 : size_; }
  // Fills `bytes`; offset + bytes.size() <= size().
  std::optional<InputError> read(std::uint64_t offset, std::span<char> bytes);

 private:
  static InputResult<InputFile> open_any(const std::string& path,
                                         std::uint64_t max_memory_bytes);

  std::string path_;
  std::uint64_t size_ = 0;
  std::unique_ptr<std::ifstream> stream_;  // none: standard input
};

// Returns the text without leading white space.
inline std::string_view after_blanks(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first == text.npos ? std::string_view() : text.substr(first);
}

// Returns the first bytes of a file, at most 64; empty if it cannot be read. Reads no more of
// standard input.
std::string beginning_of(const std::string& path);

// Reads `size` bytes from `offset`, which must be within the file.
InputResult<std::string> read_text(InputFile& file, std::uint64_t offset, std::uint64_t size);

// Reads the whole file. Errors: an empty file, or one of more than max_memory_bytes.
InputResult<std::string> read_whole_file(const std::string& path,
                                         std::uint64_t max_memory_bytes = kUsualEncoderBytes);

// Returns the message that the memory limit is exceeded.
std::string memory_problem(std::uint64_t max_memory_bytes);

// Returns an error for the first NaN or infinite value of a frame.
std::optional<InputError> check_finite(const std::string& path, std::uint32_t frame,
                                       std::span<const float> xyz);

}  // namespace rlpc
