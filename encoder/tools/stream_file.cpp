#include "encoder/tools/stream_file.h"

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace rlpc {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxTemporaries = 1000;

std::string reason(int code) { return std::generic_category().message(code); }

}  // namespace

StreamFile::StreamFile(std::string path) : path_(std::move(path)) {
  if (path_ == "-") {
    file_ = stdout;
  } else {
    open();
  }
}

void StreamFile::open() {
  std::error_code error;
  const auto type = fs::status(path_, error).type();
  if (type == fs::file_type::directory) {
    failure_ = "it is a folder; give the name of a file";
    return;
  }
  if (fs::exists(path_, error) && type != fs::file_type::regular) {
    file_ = std::fopen(path_.c_str(), "wb");
    if (file_ == nullptr) failure_ = reason(errno);
    return;
  }
  target_ = path_;
  if (fs::is_symlink(path_, error)) {
    target_ = fs::weakly_canonical(path_, error).string();
    if (error) {
      failure_ = error.message();
      return;
    }
  }
  // "x.rlpc.partial", "x.rlpc.partial1", ...: never one that somebody else writes.
  for (int attempt = 0; attempt < kMaxTemporaries; ++attempt) {
    std::string name = target_ + ".partial" + (attempt == 0 ? "" : std::to_string(attempt));
    file_ = std::fopen(name.c_str(), "wbx");
    if (file_ != nullptr) {
      temporary_ = std::move(name);
      return;
    }
    if (errno == ENOENT) {
      failure_ =
          "there is no folder " + fs::path(target_).parent_path().string() + "; make it first";
      return;
    }
    if (errno != EEXIST) {
      failure_ = reason(errno);
      return;
    }
  }
  failure_ = "too many unfinished files; remove " + target_ + ".partial*";
}

bool StreamFile::is_same_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == "-" || b == "-") return false;
  std::error_code ignored;
  if (fs::exists(a, ignored) && !fs::is_regular_file(a, ignored)) return false;
  return fs::equivalent(a, b, ignored) ||
         fs::weakly_canonical(a, ignored) == fs::weakly_canonical(b, ignored);
}

StreamFile::~StreamFile() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

bool StreamFile::write(std::span<const std::uint8_t> bytes) {
  if (!good()) return false;
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) {
    failure_ = reason(errno);
  }
  return good();
}

bool StreamFile::write(std::string_view text) {
  return write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::optional<InputError> StreamFile::commit() {
  if (good()) {
    errno = 0;
    std::FILE* const file = std::exchange(file_, nullptr);
    if ((file == stdout ? std::fflush(file) : std::fclose(file)) != 0) failure_ = reason(errno);
  }
  if (good() && !temporary_.empty()) {
    std::error_code error;
    fs::rename(temporary_, target_, error);
    if (error) failure_ = error.message();
  }
  if (good()) {
    temporary_.clear();
    return std::nullopt;
  }
  return InputError{path_ + ": cannot write: " + failure_};
}

}  // namespace rlpc
