#include "common/io/output_file.h"

#include <cassert>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace rlpc {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxTemporaries = 1000;

// "x.rlpd" -> "x.rlpd.partial", "x.rlpd.partial1", ...
std::string temporary_name(const std::string& path, int attempt) {
  return path + ".partial" + (attempt == 0 ? "" : std::to_string(attempt));
}

}  // namespace

OutputError output_error(const std::string& path, const std::string& what, int code) {
  return OutputError{path + ": cannot " + what + ": " + std::generic_category().message(code)};
}

OutputResult<OutputFile> OutputFile::create(const std::string& path) {
  if (path == "-") return OutputFile("standard output", "", "", stdout);
  std::error_code ec;
  const auto type = fs::status(path, ec).type();
  if (type == fs::file_type::directory) {
    return OutputError{path + ": is a folder; give the name of a file"};
  }
  if (fs::exists(path, ec) && type != fs::file_type::regular) {
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) return output_error(path, "open", errno);
    return OutputFile(path, path, "", file);
  }
  std::string target = path;
  if (fs::is_symlink(path, ec)) {
    target = fs::weakly_canonical(path, ec).string();
    if (ec) return output_error(path, "follow the link", ec.value());
  }
  for (int attempt = 0; attempt < kMaxTemporaries; ++attempt) {
    std::string temporary = temporary_name(target, attempt);
    std::FILE* const file = std::fopen(temporary.c_str(), "wbx");
    if (file != nullptr) return OutputFile(path, std::move(target), std::move(temporary), file);
    if (errno == ENOENT) {
      return OutputError{path + ": there is no folder " +
                         fs::path(target).parent_path().string() + "; make it first"};
    }
    if (errno != EEXIST) return output_error(path, "create", errno);
  }
  return OutputError{path + ": too many unfinished files; remove " + target + ".partial*"};
}

bool OutputFile::is_same_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == "-" || b == "-") return false;
  std::error_code ignored;
  if (fs::exists(a, ignored) && !fs::is_regular_file(a, ignored)) return false;
  return fs::equivalent(a, b, ignored) ||
         fs::weakly_canonical(a, ignored) == fs::weakly_canonical(b, ignored);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      file_(std::exchange(other.file_, nullptr)) {}

OutputFile::~OutputFile() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  std::error_code ec;
  if (!temporary_.empty()) fs::remove(temporary_, ec);
}

std::optional<OutputError> OutputFile::write(std::string_view bytes) {
  assert(file_ != nullptr);
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size()) return std::nullopt;
  return output_error(path_, "write", errno);
}

std::optional<OutputError> OutputFile::write(std::span<const std::uint8_t> bytes) {
  return write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::optional<OutputError> OutputFile::close() {
  errno = 0;
  std::FILE* const file = std::exchange(file_, nullptr);
  if ((file == stdout ? std::fflush(file) : std::fclose(file)) == 0) return std::nullopt;
  return output_error(path_, "write", errno);
}

std::optional<OutputError> OutputFile::commit() {
  assert(file_ == nullptr);
  if (temporary_.empty()) return std::nullopt;
  std::error_code ec;
  fs::rename(temporary_, target_, ec);
  if (ec) return output_error(path_, "give the finished file its name", ec.value());
  temporary_.clear();
  return std::nullopt;
}

std::optional<OutputError> write_and_commit(OutputFile& file, std::string_view bytes) {
  if (auto error = file.write(bytes)) return error;
  if (auto error = file.close()) return error;
  return file.commit();
}

OutputResult<std::string> create_temporary_folder(const std::string& path) {
  std::error_code ec;
  const bool inside = fs::is_directory(path, ec);
  const std::string base = inside ? (fs::path(path) / "frames").string() : path;
  for (int attempt = 0; attempt < kMaxTemporaries; ++attempt) {
    std::string folder = temporary_name(base, attempt);
    if (fs::create_directory(folder, ec)) return folder;
    if (ec && ec != std::errc::file_exists) return output_error(path, "create", ec.value());
  }
  return OutputError{path + ": too many unfinished folders; remove " + base + ".partial*"};
}

}  // namespace rlpc
