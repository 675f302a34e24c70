// A file that takes its name only once it is complete.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "common/result.h"

namespace rlpc {

// One line for the user: path, what failed, and the system's reason.
struct OutputError {
  std::string message;
  bool is_usage = false;  // what was asked for cannot be; no file is at fault
};
template <class T>
using OutputResult = Result<T, OutputError>;

class OutputFile {
 public:
  // Creates a temporary file beside `path`. A path that exists and is not a regular file (a
  // device, a pipe) is opened directly; a symbolic link is followed; "-" is standard output.
  static OutputResult<OutputFile> create(const std::string& path);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();  // removes the file unless commit() succeeded

  std::optional<OutputError> write(std::string_view bytes);
  std::optional<OutputError> write(std::span<const std::uint8_t> bytes);
  // Flushes, and closes all but standard output: from here on nothing but the name can fail.
  std::optional<OutputError> close();
  // After close(): gives the file its name.
  std::optional<OutputError> commit();
  // Whether writing `a` would change what reads as `b`: both lead to the same file, which is
  // one, or none yet. Not so devices and pipes, and "-".
  static bool is_same_file(const std::string& a, const std::string& b);
  // The name as the caller gave it.
  const std::string& path() const { return path_; }

 private:
  OutputFile(std::string path, std::string target, std::string temporary, std::FILE* file)
      : path_(std::move(path)),
        target_(std::move(target)),
        temporary_(std::move(temporary)),
        file_(file) {}

  std::string path_;
  std::string target_;     // where links lead to
  std::string temporary_;  // empty: written directly, or committed
  std::FILE* file_ = nullptr;
};

// All that is to be in the file; it takes its name.
std::optional<OutputError> write_and_commit(OutputFile& file, std::string_view bytes);

// A folder beside `path` with a name that did not exist, or inside it if `path` is a folder.
OutputResult<std::string> create_temporary_folder(const std::string& path);

// "PATH: cannot WHAT: REASON" with the reason of `code`, an errno value.
OutputError output_error(const std::string& path, const std::string& what, int code);

}  // namespace rlpc
