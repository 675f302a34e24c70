#include "encoder/stream_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

namespace rlpc {

StreamFile::StreamFile(std::string path) : path_(std::move(path)) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  std::string name = path_ == "-" ? "/dev/stdout" : path_;
  const bool special = fs::exists(name, ignored) && !fs::is_regular_file(name, ignored) &&
                       !fs::is_directory(name, ignored);
  if (!special) {
    temporary_ = path_ + ".partial-" + std::to_string(getpid());
    name = temporary_;
  }
  errno = 0;
  file_.open(name, std::ios::binary | std::ios::trunc);
  if (!file_) failure_ = std::strerror(errno);
}

StreamFile::~StreamFile() {
  file_.close();
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

bool StreamFile::write(std::span<const std::uint8_t> bytes) {
  if (!failure_.empty()) return false;
  errno = 0;
  file_.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
  if (!file_) failure_ = std::strerror(errno);
  return failure_.empty();
}

std::optional<InputError> StreamFile::commit() {
  if (failure_.empty()) {
    errno = 0;
    file_.close();
    if (!file_) failure_ = std::strerror(errno);
  }
  if (failure_.empty() && !temporary_.empty()) {
    std::error_code error;
    std::filesystem::rename(temporary_, path_, error);
    if (error) failure_ = error.message();
  }
  if (failure_.empty()) {
    temporary_.clear();
    return std::nullopt;
  }
  return InputError{path_ + ": cannot write: " + failure_};
}

}  // namespace rlpc
