// Shared by the fuzz targets of the binary readers: inputs as files, and reading a whole
// source.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/testing/fuzz_input.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// A file in memory, for readers that require a path.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> bytes)
      : descriptor_(memfd_create("fuzz", 0)),
        path_("/proc/self/fd/" + std::to_string(descriptor_)) {
    fuzz_check(descriptor_ >= 0);
    const auto written = write(descriptor_, bytes.data(), bytes.size());
    fuzz_check(written == static_cast<ssize_t>(bytes.size()));
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(descriptor_); }
  const std::string& path() const { return path_; }

 private:
  int descriptor_;
  std::string path_;
};

// Reads every frame and checks that all values are finite.
inline void read_all_frames(FrameSource& source) {
  fuzz_check(source.num_vertices() >= 1 && source.num_frames() >= 1);
  for (const Triangle& t : source.triangles()) {
    for (const std::uint32_t v : t) fuzz_check(v < source.num_vertices());
  }
  std::vector<float> xyz(3 * std::size_t{source.num_vertices()});
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    if (source.read_frame(f, xyz)) return;
    for (const float x : xyz) fuzz_check(std::isfinite(x));
  }
}

}  // namespace rlpc
