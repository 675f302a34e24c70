#include "encoder/meshes/open/open_source.h"

#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/syntax/stream_format.h"
#include "common/files/numbered_name.h"
#include "encoder/meshes/axes.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/input_format.h"
#include "encoder/meshes/point_cache/point_cache.h"
#include "encoder/meshes/rlpd/rlpd_reader.h"
#include "encoder/meshes/sequence/mesh_sequence.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

InputResult<std::unique_ptr<FrameSource>> open_listed(InputResult<FrameFiles> files,
                                                      const InputOptions& options) {
  if (!files) return files.error();
  return open_mesh_sequence(std::move(*files), options);
}

bool is_stream(const std::string& path) {
  return beginning_of(path).starts_with(std::string(kSignature.begin(), kSignature.end()));
}

InputResult<std::unique_ptr<FrameSource>> open_file(const InputOptions& options, bool exists) {
  using Holds = InputFormat::Holds;
  const std::string& path = options.path;
  const InputFormat* const format = format_of(path);
  if (format == nullptr && is_stream(path)) {
    return InputError{
        name_of_input(path) +
        ": is already an RLPC stream; rlpcdec decodes it, rlpcinfo makes it smaller"};
  }
  // The file may be unreadable, or a pointer in its place. (Not all of a pipe is read.)
  const bool is_whole =
      path != "-" || beginning_of(path).starts_with("version https://git-lfs");
  if (format == nullptr && exists && is_whole) {
    const auto file = InputFile::open(path, options.max_memory_bytes);
    if (!file) return file.error();
  }
  if (format == nullptr) {
    return InputError{name_of_input(path) +
                      (exists ? ": unknown kind of file" : ": no such file or folder") +
                      "; expected " + extensions_text({Holds::kMesh, Holds::kAnimation}) +
                      ", a folder of " + extensions_text({Holds::kMesh}) +
                      " files, or a pattern such as walk_%04d.obj or 'walk_*.obj'"};
  }
  switch (format->holds) {
    case Holds::kAnimation:
      return format->open(options);
    case Holds::kPoints:
      return InputError{name_of_input(path) +
                        ": a point cache has no triangles; give its mesh as the input and the "
                        "cache as 'points'"};
    default:
      return open_mesh_sequence({{path}}, options);
  }
}

InputResult<std::unique_ptr<FrameSource>> open_with_its_axes(const InputOptions& options) {
  const std::string& path = options.path;
  std::error_code ec;
  if (!options.more_paths.empty()) {
    std::vector<std::string> paths{path};
    paths.insert(paths.end(), options.more_paths.begin(), options.more_paths.end());
    return open_listed(list_mesh_files(paths), options);
  }
  const bool exists = path == "-" || fs::exists(path, ec);
  if (!options.points.empty()) {
    const InputFormat* const format = format_of(options.points);
    const bool known = format != nullptr && format->open_points != nullptr;
    return (known ? format->open_points : open_point_cache)(options);
  }
  if (fs::is_directory(path, ec)) return open_listed(list_mesh_folder(path), options);
  // A file with exactly this name takes precedence over a pattern.
  const std::string name = fs::path(path).filename().string();
  const bool is_glob = name.find('%') == name.npos && name.find_first_of("*?[") != name.npos;
  if (!exists && is_glob) return open_listed(list_mesh_glob(path), options);
  if (!exists && is_pattern(name)) return open_listed(list_mesh_pattern(path), options);
  return open_file(options, exists);
}

bool is_gltf(const std::string& path) {
  const InputFormat* const format = format_of(path);
  return format != nullptr && format->has_clips;
}

}  // namespace
bool has_clips(const InputOptions& options) {
  return options.more_paths.empty() && options.points.empty() && is_gltf(options.path);
}

std::optional<InputError> check_gltf_options(const InputOptions& options) {
  if (!options.points.empty() && is_gltf(options.path)) {
    return InputError{name_of_input(options.path) +
                      ": a glTF file brings its own animation and takes no 'points'; leave it "
                      "out, or replace this file by the mesh (" +
                      extensions_text({InputFormat::Holds::kMesh}) + ") of " +
                      name_of_input(options.points)};
  }
  if ((options.animations.empty() && options.weld) || has_clips(options)) return std::nullopt;
  return InputError{
      name_of_input(options.path) +
      (options.weld ? ": 'animations' is for .glb and .gltf files"
                    : ": 'weld = false' is for .glb and .gltf files; other formats are never "
                      "welded")};
}

InputResult<std::unique_ptr<FrameSource>> open_frame_source(const InputOptions& options) {
  if (!options.more_paths.empty() && !options.points.empty()) {
    return InputError{
        name_of_input(options.points) +
        ": a point cache has the frames of one mesh; give one mesh with 'points'"};
  }
  if (auto error = check_gltf_options(options)) return *error;
  auto source = open_with_its_axes(options);
  if (source) (*source)->limit_attributes(kMaxAttributeSets);
  if (!source || !options.axes) return source;
  return turn_source(std::move(*source), *options.axes);
}

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
