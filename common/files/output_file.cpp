#include "common/files/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <climits>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/files/interrupts.h"
#include "common/files/messages.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxTemporaries = 1000;

std::size_t longest_name(const fs::path& folder) {
  const long longest = pathconf(folder.empty() ? "." : folder.c_str(), _PC_NAME_MAX);
  return longest > 0 ? static_cast<std::size_t>(longest) : NAME_MAX;
}

// Returns a temporary name: "x.rlpd" -> "x.rlpd.partial", "x.rlpd.partial1", ...; long names
// are cut.
std::string temporary_name(const fs::path& path, int attempt) {
  const std::string end = ".partial" + (attempt == 0 ? "" : std::to_string(attempt));
  std::string name = path.filename().string();
  const std::size_t max = longest_name(path.parent_path()) - end.size();
  if (name.size() > max) {
    std::size_t size = max;
    while (size > 0 && (name[size] & 0xC0) == 0x80) --size;  // whole characters of UTF-8
    name.resize(size);
  }
  return (path.parent_path() / (name + end)).string();
}

// Resolves symbolic links, whether or not the target exists.
OutputResult<std::string> end_of_links(const std::string& path) {
  constexpr int kMaxLinks = 40;
  fs::path at = path;
  for (int links = 0; links < kMaxLinks; ++links) {
    std::error_code ec;
    if (!fs::is_symlink(at, ec)) return at.string();
    const fs::path to = fs::read_symlink(at, ec);
    if (ec) return output_error(path, "follow the link", ec.value());
    at = at.parent_path() / to;  // `to` itself if it is absolute
  }
  return output_error(path, "follow the link", ELOOP);
}

// Gives a replacement the permissions of the file that it replaces.
void take_permissions(int file, const struct stat& replaced) {
  mode_t mode = replaced.st_mode & 0777;
  // In another group, the same bits would grant access to others.
  if (fchown(file, replaced.st_uid, replaced.st_gid) != 0 &&
      fchown(file, static_cast<uid_t>(-1), replaced.st_gid) != 0) {
    mode &= 0707;
  }
  // Fails harmlessly on file systems without permissions.
  if (fchmod(file, mode) != 0) return;
}

// Flushes to the disk, so that after a system crash the file has either the old or the new
// contents. Not supported by all file systems and files.
std::optional<OutputError> sync(const std::string& path, int file) {
  if (fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP || errno == ENOSYS) {
    return std::nullopt;
  }
  return output_error(path, "write", errno);
}

void sync_folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  const int file = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  fsync(file);
  close(file);
}

}  // namespace

OutputError output_error(const std::string& path, const std::string& what, int code) {
  return OutputError{path + ": cannot " + what + ": " + std::generic_category().message(code)};
}

OutputError OutputLimit::exceeded(const std::string& path) const {
  return OutputError{path + ": has more than the " + size_text(max_bytes) + " of 'max_bytes'",
                     false, true};
}

OutputResult<OutputFile> OutputFile::create(const std::string& path,
                                            std::shared_ptr<OutputLimit> limit) {
  if (path == "-") return OutputFile("standard output", "", "", stdout, std::move(limit));
  struct stat there {};
  const bool exists = stat(path.c_str(), &there) == 0;
  if (exists && S_ISDIR(there.st_mode)) {
    return OutputError{path + ": is a folder; give the name of a file"};
  }
  if (exists && !S_ISREG(there.st_mode)) {
    std::FILE* const file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) return output_error(path, "open", errno);
    return OutputFile(path, path, "", file, std::move(limit));
  }
  auto target = end_of_links(path);
  if (!target) return target.error();
  for (int attempt = 0; attempt < kMaxTemporaries; ++attempt) {
    std::string temporary = temporary_name(*target, attempt);
    const HoldInterrupts hold;
    const int file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
                          exists ? mode_t{0600} : mode_t{0666});
    if (file >= 0) {
      add_unfinished(temporary);
      if (exists) take_permissions(file, there);
      OutputFile created(path, std::move(*target), std::move(temporary), fdopen(file, "wb"),
                         std::move(limit));
      if (created.file_ != nullptr) return created;
      ::close(file);
      return output_error(path, "create", ENOMEM);
    }
    if (errno == ENOENT) {
      return OutputError{path + ": there is no folder " +
                         fs::path(*target).parent_path().string() + "; make it first"};
    }
    if (errno != EEXIST) return output_error(path, "create", errno);
  }
  return OutputError{path + ": too many unfinished files; remove " + *target + ".partial*"};
}

OutputResult<OutputFile> OutputFile::create_within(const std::string& path,
                                                   std::shared_ptr<OutputLimit> limit) {
  // Nothing may be added to the folder while a signal removes it.
  const HoldInterrupts hold;
  std::FILE* const file = std::fopen(path.c_str(), "wbx");
  if (file == nullptr) return output_error(path, "create", errno);
  return OutputFile(path, path, "", file, std::move(limit));
}

bool OutputFile::is_same_file(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == "-" || b == "-") return false;
  std::error_code ignored;
  if (fs::exists(a, ignored) && !fs::is_regular_file(a, ignored)) return false;
  if (fs::equivalent(a, b, ignored)) return true;
  const auto end_of_a = end_of_links(a);
  const auto end_of_b = end_of_links(b);
  return end_of_a && end_of_b &&
         fs::weakly_canonical(*end_of_a, ignored) == fs::weakly_canonical(*end_of_b, ignored);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::exchange(other.temporary_, {})),
      file_(std::exchange(other.file_, nullptr)),
      limit_(std::move(other.limit_)) {}

OutputFile::~OutputFile() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  if (temporary_.empty()) return;
  const HoldInterrupts hold;
  std::error_code ec;
  fs::remove(temporary_, ec);
  remove_unfinished(temporary_);
}

std::optional<OutputError> OutputFile::write(std::string_view bytes) {
  assert(file_ != nullptr);
  if (limit_ != nullptr) {
    if (bytes.size() > limit_->left) return limit_->exceeded(path_);
    limit_->left -= bytes.size();
  }
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size()) return std::nullopt;
  return output_error(path_, "write", errno);
}

std::optional<OutputError> OutputFile::write(std::span<const std::uint8_t> bytes) {
  return write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::optional<OutputError> OutputFile::flush() {
  errno = 0;
  if (std::fflush(file_) != 0) return output_error(path_, "write", errno);
  return std::nullopt;
}

std::optional<OutputError> OutputFile::close() {
  errno = 0;
  std::FILE* const file = std::exchange(file_, nullptr);
  std::optional<OutputError> failure;
  if (std::fflush(file) != 0) failure = output_error(path_, "write", errno);
  if (!failure && !temporary_.empty()) failure = sync(path_, fileno(file));
  if (file == stdout) return failure;
  if (std::fclose(file) != 0 && !failure) failure = output_error(path_, "write", errno);
  return failure;
}

std::optional<OutputError> OutputFile::commit() {
  assert(file_ == nullptr);
  if (temporary_.empty()) return std::nullopt;
  const HoldInterrupts hold;
  std::error_code ec;
  fs::rename(temporary_, target_, ec);
  if (ec) return output_error(path_, "rename the finished file", ec.value());
  remove_unfinished(temporary_);
  temporary_.clear();
  sync_folder_of(target_);
  return std::nullopt;
}

std::optional<OutputError> write_and_commit(OutputFile& file, std::string_view bytes) {
  if (auto error = file.write(bytes)) return error;
  if (auto error = file.close()) return error;
  return file.commit();
}

OutputResult<TemporaryFolder> TemporaryFolder::create(const std::string& path) {
  std::error_code ec;
  const bool inside = fs::is_directory(path, ec);
  const fs::path base = inside ? fs::path(path) / "frames" : fs::path(path);
  for (int attempt = 0; attempt < kMaxTemporaries; ++attempt) {
    std::string folder = temporary_name(base, attempt);
    const HoldInterrupts hold;
    if (fs::create_directory(folder, ec)) {
      add_unfinished(folder);
      // Its files may replace others with restricted permissions.
      if (inside) fs::permissions(folder, fs::perms::owner_all, ec);
      return TemporaryFolder(std::move(folder));
    }
    if (ec && ec != std::errc::file_exists) return output_error(path, "create", ec.value());
  }
  return OutputError{path + ": too many unfinished folders; remove " + base.string() +
                     ".partial*"};
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

TemporaryFolder::~TemporaryFolder() {
  if (path_.empty()) return;
  const HoldInterrupts hold;
  std::error_code ec;
  fs::remove_all(path_, ec);
  remove_unfinished(path_);
}

std::optional<OutputError> TemporaryFolder::sync() const {
  const int folder = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  if (folder < 0) return output_error(path_, "write", errno);
#ifdef __linux__
  const bool good = syncfs(folder) == 0;  // all files at once; fsync() would wait for each
#else
  const bool good = fsync(folder) == 0;
#endif
  const int reason = errno;
  close(folder);
  return good ? std::nullopt : std::optional(output_error(path_, "write", reason));
}

std::optional<OutputError> TemporaryFolder::commit(const std::string& path) {
  const HoldInterrupts hold;
  std::error_code ec;
  fs::rename(path_, path, ec);
  if (ec) return output_error(path, "name the finished folder", ec.value());
  remove_unfinished(path_);
  path_.clear();
  sync_folder_of(path);
  return std::nullopt;
}

std::optional<OutputError> TemporaryFolder::commit_file(const std::string& name,
                                                        const std::string& path) const {
  auto target = end_of_links(path);
  if (!target) return target.error();
  const std::string temporary = (fs::path(path_) / name).string();
  struct stat there {};
  if (stat(target->c_str(), &there) == 0) {
    const int file = open(temporary.c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) return output_error(path, "replace", errno);
    take_permissions(file, there);
    close(file);
  }
  std::error_code ec;
  fs::rename(temporary, *target, ec);
  if (ec) return output_error(path, "name the finished file", ec.value());
  return std::nullopt;
}

}  // namespace rlpc
