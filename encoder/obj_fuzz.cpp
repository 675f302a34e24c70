// Fuzzes the OBJ reader: what it accepts has finite positions and indices in range.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/fuzz_input.h"
#include "encoder/obj_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto mesh =
      rlpc::parse_obj(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.obj");
  if (!mesh) {
    rlpc::fuzz_check(mesh.error().message.starts_with("fuzz.obj:"));
    return 0;
  }
  rlpc::fuzz_check(!mesh->xyz.empty() && mesh->xyz.size() % 3 == 0);
  for (const float x : mesh->xyz) rlpc::fuzz_check(std::isfinite(x));
  for (const rlpc::Triangle& t : mesh->triangles) {
    for (const std::uint32_t v : t) rlpc::fuzz_check(v < mesh->xyz.size() / 3);
  }
  if (mesh->frame_rate) {
    rlpc::fuzz_check(mesh->frame_rate->numerator >= 1 && mesh->frame_rate->denominator >= 1);
  }
  return 0;
}
