// Fuzzes the MDD point cache reader. Input: see encoder/meshes/fuzz/point_cache_fuzz.h.

#include <cstddef>
#include <cstdint>

#include "encoder/meshes/fuzz/point_cache_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rlpc::read_point_cache(data, size, ".mdd");
  return 0;
}
