#include "decoder/meshes/rlpa_file.h"

#include "common/files/binary_numbers.h"

namespace rlpc {
namespace {

// WriteSet( )
void append_set(std::string& bytes, const AttributeSet& set) {
  const AttributeHeader& header = set.header;
  append_u32(bytes, static_cast<std::uint32_t>(header.name.size()));
  bytes += header.name;
  bytes.append((4 - header.name.size() % 4) % 4, '\0');
  append_u32(bytes, static_cast<std::uint32_t>(header.domain));
  append_u32(bytes, static_cast<std::uint32_t>(header.kind));
  append_u32(bytes, static_cast<std::uint32_t>(header.scale));
  append_u32(bytes, static_cast<std::uint32_t>(header.weight));
  append_u32(bytes, header.num_components);
  append_u32(bytes, header.value_bits);
  append_i32(bytes, header.log2_step);
  for (std::uint32_t c = 0; c < header.num_components; ++c) append_i32(bytes, header.origin[c]);
  append_u32(bytes, static_cast<std::uint32_t>(set.num_values()));
  for (const std::uint32_t x : set.value_of_corner) append_u32(bytes, x);
  for (const std::uint32_t f : set.face_of_triangle) append_u32(bytes, f);
  for (const std::uint32_t value : set.values) append_u32(bytes, value);
}

}  // namespace

std::string rlpa_bytes(std::uint32_t num_vertices, std::uint32_t num_triangles,
                       const std::vector<AttributeSet>& sets) {
  std::string bytes = "RLPA";
  append_u32(bytes, 1);
  append_u32(bytes, num_vertices);
  append_u32(bytes, num_triangles);
  append_u32(bytes, static_cast<std::uint32_t>(sets.size()));
  for (const AttributeSet& set : sets) append_set(bytes, set);
  return bytes;
}

std::optional<OutputError> write_rlpa(const std::string& path, std::uint32_t num_vertices,
                                      std::uint32_t num_triangles,
                                      const std::vector<AttributeSet>& sets) {
  auto file = OutputFile::create(path);
  if (!file) return file.error();
  if (auto error = file->write(rlpa_bytes(num_vertices, num_triangles, sets))) return error;
  if (auto error = file->close()) return error;
  return file->commit();
}

}  // namespace rlpc
