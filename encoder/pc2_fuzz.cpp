// Fuzzes the point cache reader. Input: vertices of the mesh minus 1, 1 byte; the point cache.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "encoder/binary_source_fuzz.h"
#include "encoder/pc2_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rlpc::FuzzInput input(data, size);
  std::string obj;
  const std::uint32_t last = input.number(1);
  for (std::uint32_t v = 0; v <= last; ++v) obj += "v 0 0 0\n";
  const rlpc::MemoryFile mesh(
      std::span(reinterpret_cast<const std::uint8_t*>(obj.data()), obj.size()));
  const rlpc::MemoryFile points(input.rest());
  const auto source = rlpc::open_pc2(mesh.path(), points.path(), std::nullopt);
  if (source) rlpc::read_all_frames(**source);
  return 0;
}
