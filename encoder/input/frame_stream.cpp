#include "encoder/input/frame_stream.h"

#include "encoder/input/formats/point_cache.h"
#include "encoder/input/formats/rlpd_reader.h"

namespace rlpc {

InputResult<std::unique_ptr<FrameStream>> open_frame_stream(
    std::FILE* file, const std::string& mesh_path, const std::optional<FrameRate>& frame_rate,
    std::uint64_t max_memory_bytes) {
  const std::string name = "standard input";
  // Without a buffer, a frame is read as soon as it has come.
  std::setvbuf(file, nullptr, _IONBF, 0);
  if (mesh_path.empty()) return open_rlpd_stream(file, name, frame_rate, max_memory_bytes);
  return open_pc2_stream(file, name, mesh_path, frame_rate, max_memory_bytes);
}

}  // namespace rlpc
