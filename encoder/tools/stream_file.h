// A file of the encoder's: under a temporary name until it is whole.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "encoder/input/frame_source.h"

namespace rlpc {

class StreamFile {
 public:
  // "-" is standard output. A symbolic link is followed; what is no regular file (a device, a
  // pipe) is written directly. Opened at once, so that an unwritable place is known before the
  // work.
  explicit StreamFile(std::string path);
  StreamFile(const StreamFile&) = delete;
  StreamFile& operator=(const StreamFile&) = delete;
  ~StreamFile();  // removes what is not committed

  // Whether writing `a` would change what reads as `b`: both lead to the same file, which is
  // one, or none yet. Not so devices and pipes, and "-".
  static bool is_same_file(const std::string& a, const std::string& b);

  // False after a failure, here or earlier; commit() tells of it.
  bool write(std::span<const std::uint8_t> bytes);
  bool write(std::string_view text);
  bool good() const { return failure_.empty(); }
  // Gives the file its name. The error names the path and the system's reason, also that of an
  // earlier failure.
  std::optional<InputError> commit();

 private:
  void open();

  std::string path_;
  std::string target_;     // where links lead to
  std::string temporary_;  // empty: written directly, or committed
  std::FILE* file_ = nullptr;
  std::string failure_;
};

}  // namespace rlpc
