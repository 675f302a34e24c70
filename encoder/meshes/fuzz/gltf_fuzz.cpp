// Fuzzes the reader of glTF documents, .glb and .gltf.

#include <cstddef>
#include <cstdint>

#include "encoder/meshes/fuzz/binary_source_fuzz.h"
#include "encoder/meshes/gltf/source.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const rlpc::MemoryFile file({data + 1, size - 1});
  rlpc::InputOptions options;
  options.path = file.path();
  if ((data[0] & 1) != 0) options.animations = {"all"};
  options.weld = (data[0] & 2) != 0;
  options.frame_rate = rlpc::FrameRate{1 + data[0] / 4U, 1};
  rlpc::GltfLimits limits;
  limits.max_vertices = 10000;
  limits.max_triangles = 10000;
  limits.max_positions = 100000;
  limits.spare_values = 10000;
  const auto source = rlpc::open_gltf(options, limits);
  if (!source) {
    rlpc::fuzz_check(source.error().message.starts_with(file.path()));
    return 0;
  }
  rlpc::read_all_frames(**source);
  return 0;
}
