// Fuzzes the reader of .rlpd files (Annex A).

#include <cstddef>
#include <cstdint>

#include "encoder/meshes/fuzz/binary_source_fuzz.h"
#include "encoder/meshes/rlpd/rlpd_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const rlpc::MemoryFile file({data, size});
  const auto source = rlpc::open_rlpd(file.path(), std::nullopt);
  if (source) rlpc::read_all_frames(**source);
  return 0;
}
