// Output files and folders that appear under their names only when complete.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "common/result.h"

namespace rlpc {

// Error of an output file.
struct OutputError {
  std::string message;    // one line for the user: path, what failed, and the system's reason
  bool is_usage = false;  // the request is impossible; no file is at fault
  bool is_limit = false;  // the request exceeds a limit of the caller
};
template <class T>
using OutputResult = Result<T, OutputError>;

// Limit of the total bytes written to all files that share it.
struct OutputLimit {
  explicit OutputLimit(std::uint64_t bytes) : max_bytes(bytes), left(bytes) {}
  // Returns the error of a `path` that exceeds the limit.
  OutputError exceeded(const std::string& path) const;

  std::uint64_t max_bytes;
  std::uint64_t left;
};

class OutputFile {
 public:
  // Creates a temporary file next to `path`, with the permissions of the file that it will
  // replace. An existing path that is not a regular file (a device, a pipe) is opened directly;
  // symbolic links are followed, dangling ones as well; "-" is standard output. limit: null for
  // none.
  static OutputResult<OutputFile> create(const std::string& path,
                                         std::shared_ptr<OutputLimit> limit = nullptr);
  // Creates a file in a TemporaryFolder, under its own name.
  static OutputResult<OutputFile> create_within(const std::string& path,
                                                std::shared_ptr<OutputLimit> limit = nullptr);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();  // removes the file unless commit() succeeded

  std::optional<OutputError> write(std::string_view bytes);
  std::optional<OutputError> write(std::span<const std::uint8_t> bytes);
  // Flushes what has been written to readers of a pipe.
  std::optional<OutputError> flush();
  // Flushes to the disk, and closes unless standard output: afterwards only renaming can fail.
  std::optional<OutputError> close();
  // Renames the file to its name, after close().
  std::optional<OutputError> commit();
  // Returns whether writing `a` would overwrite `b`: both names refer to the same file,
  // existing or not. False for devices, pipes and "-".
  static bool is_same_file(const std::string& a, const std::string& b);
  // Returns the name that the caller passed.
  const std::string& path() const { return path_; }

 private:
  OutputFile(std::string path, std::string target, std::string temporary, std::FILE* file,
             std::shared_ptr<OutputLimit> limit)
      : path_(std::move(path)),
        target_(std::move(target)),
        temporary_(std::move(temporary)),
        file_(file),
        limit_(std::move(limit)) {}

  std::string path_;
  std::string target_;     // path with links resolved
  std::string temporary_;  // empty: written directly, or committed
  std::FILE* file_ = nullptr;
  std::shared_ptr<OutputLimit> limit_;
};

// Writes the whole contents and commits.
std::optional<OutputError> write_and_commit(OutputFile& file, std::string_view bytes);

// New folder that appears, with all its files, only when complete.
class TemporaryFolder {
 public:
  // Creates a temporary folder next to `path`, or inside it if `path` is a folder.
  static OutputResult<TemporaryFolder> create(const std::string& path);

  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder();  // removes the folder with its contents unless commit() succeeded

  const std::string& path() const { return path_; }
  // Flushes the folder and its contents to the disk.
  std::optional<OutputError> sync() const;
  // Renames the folder to `path`, which must not exist.
  std::optional<OutputError> commit(const std::string& path);
  // Moves one of its files to `path`, replacing a file there, as OutputFile does.
  std::optional<OutputError> commit_file(const std::string& name,
                                         const std::string& path) const;

 private:
  explicit TemporaryFolder(std::string path) : path_(std::move(path)) {}

  std::string path_;  // empty: committed
};

// Returns the error "PATH: cannot WHAT: REASON" with the reason of `code`, an errno value.
OutputError output_error(const std::string& path, const std::string& what, int code);

}  // namespace rlpc
