// Shared by the fuzz targets of point caches: a mesh of 1 to 256 vertices with a point cache.
// Input: number of vertices minus 1, 1 byte; the contents of the point cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "encoder/meshes/fuzz/binary_source_fuzz.h"
#include "encoder/meshes/point_cache/point_cache.h"

namespace rlpc {

// Reads a point cache. extension: extension of the point cache file.
inline void read_point_cache(const std::uint8_t* data, std::size_t size,
                             const std::string& extension) {
  FuzzInput input(data, size);
  std::string obj;
  const std::uint32_t last = input.number(1);
  for (std::uint32_t v = 0; v <= last; ++v) obj += "v 0 0 0\n";
  const MemoryFile mesh(
      std::span(reinterpret_cast<const std::uint8_t*>(obj.data()), obj.size()));
  const MemoryFile points(input.rest());
  static const std::string kLink =
      (std::filesystem::temp_directory_path() / ("fuzz" + std::to_string(getpid()))).string();
  const std::string link = kLink + extension;
  std::filesystem::remove(link);
  std::filesystem::create_symlink(points.path(), link);
  InputOptions options;
  options.path = mesh.path();
  options.points = link;
  const auto source = open_point_cache(options);
  if (source) read_all_frames(**source);
  std::filesystem::remove(link);
}

}  // namespace rlpc
