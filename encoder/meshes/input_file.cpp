#include "encoder/meshes/input_file.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "common/files/bounded_input.h"

namespace rlpc {

namespace {

PipedInput& standard_input() {
  static PipedInput input(stdin);
  return input;
}

// Beginning of the texts that Git keeps in place of large files.
constexpr std::string_view kLfsPointer = "version https://git-lfs";
constexpr std::uint64_t kMaxLfsPointerBytes = 1024;

std::span<std::uint8_t> as_bytes(std::span<char> text) {
  return {reinterpret_cast<std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

std::string memory_problem(std::uint64_t max_memory_bytes) {
  return "needs more memory than the limit of " + size_text(max_memory_bytes) +
         " ('max_memory_bytes')";
}

InputResult<InputFile> InputFile::open(const std::string& path,
                                       std::uint64_t max_memory_bytes) {
  auto file = open_any(path, max_memory_bytes);
  if (!file) return file;
  std::array<char, kLfsPointer.size()> beginning{};
  if (file->size() < beginning.size() || file->size() > kMaxLfsPointerBytes) return file;
  if (auto error = file->read(0, beginning)) return *error;
  if (std::string_view(beginning.data(), beginning.size()) != kLfsPointer) return file;
  return InputError{file->path() +
                    ": is a Git LFS pointer, a text in place of the file; `git lfs pull` "
                    "fetches the file itself"};
}

InputResult<InputFile> InputFile::open_any(const std::string& path,
                                           std::uint64_t max_memory_bytes) {
  InputFile file;
  file.path_ = name_of_input(path);
  if (path == "-") {
    const PipedInput::State state = standard_input().read_rest(max_memory_bytes);
    if (state == PipedInput::State::kTooLarge) {
      return InputError{file.path_ + ": " + memory_problem(max_memory_bytes)};
    }
    if (state == PipedInput::State::kFailed) {
      return InputError{file.path_ + ": reading it failed"};
    }
    file.size_ = standard_input().size();
    return file;
  }
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (status.type() == std::filesystem::file_type::not_found) {
    return InputError{path + ": no such file; check the name and the folder"};
  }
  if (status.type() != std::filesystem::file_type::regular) {
    return InputError{path + ": not a regular file" + (ec ? " (" + ec.message() + ")" : "")};
  }
  file.size_ = std::filesystem::file_size(path, ec);
  if (ec) return InputError{path + ": cannot find its size: " + ec.message()};
  errno = 0;
  file.stream_ = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*file.stream_) {
    return InputError{path + ": cannot be opened: " + std::generic_category().message(errno)};
  }
  return file;
}

std::optional<InputError> InputFile::read(std::uint64_t offset, std::span<char> bytes) {
  assert(offset <= size_ && bytes.size() <= size_ - offset);
  if (!stream_) {
    standard_input().copy(offset, as_bytes(bytes));
    return std::nullopt;
  }
  stream_->clear();
  stream_->seekg(static_cast<std::streamoff>(offset));
  stream_->read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (*stream_) return std::nullopt;
  return InputError{path_ + ": reading " + std::to_string(bytes.size()) + " bytes at byte " +
                    std::to_string(offset) + " failed; was the file changed meanwhile?"};
}

std::string beginning_of(const std::string& path) {
  if (path == "-") {
    const auto bytes = standard_input().beginning();
    return {bytes.begin(), bytes.end()};
  }
  auto file = InputFile::open(path);
  if (!file) return {};
  constexpr std::uint64_t kEnough = 64;
  std::string text(static_cast<std::size_t>(std::min(file->size(), kEnough)), '\0');
  if (file->read(0, text)) return {};
  return text;
}

InputResult<std::string> read_text(InputFile& file, std::uint64_t offset, std::uint64_t size) {
  std::string text;
  if (size > text.max_size()) {  // possible where std::size_t has 32 bits
    return InputError{file.path() + ": " + std::to_string(size) +
                      " bytes are more than this machine can address; use a 64-bit one"};
  }
  text.resize(static_cast<std::size_t>(size));
  if (auto error = file.read(offset, text)) return *error;
  return text;
}

InputResult<std::string> read_whole_file(const std::string& path,
                                         std::uint64_t max_memory_bytes) {
  auto file = InputFile::open(path, max_memory_bytes);
  if (!file) return file.error();
  if (file->size() == 0) return InputError{file->path() + ": the file is empty"};
  if (file->size() + file->memory_bytes() > max_memory_bytes) {
    return InputError{file->path() + ": " + memory_problem(max_memory_bytes)};
  }
  return read_text(*file, 0, file->size());
}

std::optional<InputError> check_finite(const std::string& path, std::uint32_t frame,
                                       std::span<const float> xyz) {
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    if (std::isfinite(xyz[i])) continue;
    return InputError{path + ": frame " + std::to_string(frame) + ", vertex " +
                      std::to_string(i / 3) + " (both from 0): " + "xyz"[i % 3] + " is " +
                      (std::isnan(xyz[i]) ? "not a number" : "infinite") +
                      "; every coordinate must be finite"};
  }
  return std::nullopt;
}

}  // namespace rlpc
