#include "decoder/frame_sink.h"

#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

namespace rlpc {

namespace {

// Extensions that stand for a file of a kind that cannot be written, not for a folder.
constexpr std::array<std::string_view, 10> kOtherFiles{
    ".ply", ".stl", ".fbx", ".abc", ".glb", ".gltf", ".mdd", ".txt", ".rlpc", ".zip"};

}  // namespace

OutputResult<std::unique_ptr<FrameSink>> open_frame_sink(const std::string& path,
                                                         SinkOptions options) {
  const std::filesystem::path name = std::filesystem::path(path).filename();
  if (name.string().find('%') != std::string::npos) {
    return open_obj_sink(path, std::move(options));
  }
  std::string extension = name.extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (extension == ".rlpd") return open_rlpd_sink(path, std::move(options));
  if (extension == ".pc2") return open_pc2_sink(path, std::move(options));
  if (extension == ".obj" && options.num_frames == 1) {
    return open_single_obj_sink(path, std::move(options));
  }
  if (extension == ".obj") {
    return OutputError{path +
                       ": one OBJ file holds one frame; give a folder, a name with a "
                       "number as in frame_%04d.obj, or X.pc2 (which also writes X.obj)"};
  }
  for (const std::string_view other : kOtherFiles) {
    if (extension == other) {
      return OutputError{path + ": cannot write " + extension +
                         " files; expected .rlpd, .pc2, frame_%04d.obj or a folder"};
    }
  }
  return open_obj_sink((std::filesystem::path(path) / "frame_%04d.obj").string(),
                       std::move(options));
}

}  // namespace rlpc
