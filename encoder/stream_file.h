// The file a stream goes to: under a temporary name until it is whole.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <span>
#include <string>

#include "encoder/input/frame_source.h"

namespace rlpc {

class StreamFile {
 public:
  // "-" is standard output. Opened at once, so that an unwritable place is known before the
  // work.
  explicit StreamFile(std::string path);
  StreamFile(const StreamFile&) = delete;
  StreamFile& operator=(const StreamFile&) = delete;
  ~StreamFile();  // removes what is not committed

  bool write(std::span<const std::uint8_t> bytes);
  // Gives the file its name. The error names the path and the system's reason, also that of an
  // earlier failure.
  std::optional<InputError> commit();

 private:
  std::string path_;
  std::string temporary_;  // empty: standard output or a device
  std::ofstream file_;
  std::string failure_;
};

}  // namespace rlpc
