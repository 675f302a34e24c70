#include "encoder/meshes/mesh_reader.h"

#include <filesystem>
#include <utility>

#include "encoder/meshes/input_file.h"
#include "encoder/meshes/input_format.h"

namespace rlpc {

std::string lower_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return extension;
}

bool is_mesh_extension(const std::string& path) {
  const InputFormat* const format = format_of_extension(path);
  return format != nullptr && format->holds == InputFormat::Holds::kMesh;
}

InputResult<SingleMesh> read_mesh(const std::string& path, std::uint64_t max_memory_bytes,
                                  bool with_attributes, bool cuts_polygons) {
  const std::string name = name_of_input(path);
  const InputFormat* const format = format_of(path);
  const bool known = format != nullptr && format->parse != nullptr;
  const InputError unknown{name + ": not a mesh (" +
                           extensions_text({InputFormat::Holds::kMesh}) +
                           "), by neither name nor contents"};
  // Rejects unknown formats without reading all of standard input.
  if (path == "-" && !known && !beginning_of(path).empty()) return unknown;
  const auto text = read_whole_file(path, max_memory_bytes);
  if (!text) return text.error();
  if (!known) return unknown;
  return format->parse(
      *text, name,
      {max_memory_bytes, max_memory_bytes - text->size(), with_attributes, cuts_polygons});
}

FrameSource::Shape shape_of(SingleMesh mesh, std::uint32_t num_frames,
                            const std::optional<FrameRate>& frame_rate,
                            const FrameRate& usual) {
  FrameSource::Shape shape;
  shape.memory_bytes = 12 * std::uint64_t{mesh.triangles.size()} +
                       mesh.attributes.memory_bytes() + mesh.asset.size();
  shape.num_vertices = static_cast<std::uint32_t>(mesh.xyz.size() / 3);
  shape.num_frames = num_frames;
  shape.frame_rate = frame_rate.value_or(mesh.frame_rate.value_or(usual));
  shape.triangles = std::move(mesh.triangles);
  shape.attributes = std::move(mesh.attributes);
  shape.asset = std::move(mesh.asset);
  shape.materials = std::move(mesh.materials);
  shape.notes = std::move(mesh.notes);
  shape.files = std::move(mesh.material_files);
  return shape;
}

}  // namespace rlpc
