#include "encoder/input/mesh_reader.h"

#include <filesystem>
#include <string_view>
#include <utility>

#include "encoder/input/formats/obj_reader.h"
#include "encoder/input/formats/off_reader.h"
#include "encoder/input/formats/ply_reader.h"
#include "encoder/input/input_file.h"

namespace rlpc {

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return extension;
}

bool is_mesh_extension(const std::string& extension) {
  return extension == ".obj" || extension == ".ply" || extension == ".off";
}

std::string mesh_format_of(const std::string& path) {
  std::string extension = lower_extension(path);
  if (is_mesh_extension(extension)) return extension;
  const std::string begin = beginning_of(path);
  if (begin.starts_with("ply\n") || begin.starts_with("ply\r")) return ".ply";
  const std::size_t first = begin.find_first_not_of(" \t\r\n");
  if (first == begin.npos) return "";
  const std::string_view text = std::string_view(begin).substr(first);
  if (looks_like_off(text)) return ".off";
  const bool obj = text.starts_with("#") || text.starts_with("v ") || text.starts_with("o ");
  return obj ? ".obj" : "";
}

InputResult<SingleMesh> read_mesh(const std::string& path) {
  const auto text = read_whole_file(path);
  if (!text) return text.error();
  const std::string name = name_of_input(path);
  const std::string format = mesh_format_of(path);
  if (format == ".obj") return parse_obj(*text, name);
  if (format == ".ply") return parse_ply(*text, name);
  if (format == ".off") return parse_off(*text, name);
  return InputError{name + ": not an OBJ, PLY or OFF file, neither by name nor by content"};
}

FrameSource::Shape shape_of(SingleMesh mesh, std::uint32_t num_frames,
                            const std::optional<FrameRate>& frame_rate,
                            const FrameRate& usual) {
  FrameSource::Shape shape;
  shape.num_vertices = static_cast<std::uint32_t>(mesh.xyz.size() / 3);
  shape.num_frames = num_frames;
  shape.frame_rate = frame_rate.value_or(mesh.frame_rate.value_or(usual));
  shape.triangles = std::move(mesh.triangles);
  return shape;
}

}  // namespace rlpc
