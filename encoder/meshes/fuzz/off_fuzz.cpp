// Fuzzes the OFF reader: what it accepts has finite positions and indices in range.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "encoder/meshes/fuzz/mesh_fuzz.h"
#include "encoder/meshes/off/off_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  rlpc::check_mesh(rlpc::parse_off(text, "fuzz.mesh"));
  return 0;
}
