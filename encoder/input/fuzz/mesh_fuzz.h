// Shared by the fuzz targets of the mesh readers: the properties they check. Files are called
// "fuzz.mesh".
#pragma once

#include <cmath>
#include <cstdint>

#include "common/testing/fuzz_input.h"
#include "encoder/input/mesh_reader.h"

namespace rlpc {

inline void check_mesh(const InputResult<SingleMesh>& mesh) {
  if (!mesh) {
    fuzz_check(mesh.error().message.starts_with("fuzz.mesh:"));
    return;
  }
  fuzz_check(!mesh->xyz.empty() && mesh->xyz.size() % 3 == 0);
  for (const float x : mesh->xyz) fuzz_check(std::isfinite(x));
  for (const Triangle& t : mesh->triangles) {
    for (const std::uint32_t v : t) fuzz_check(v < mesh->xyz.size() / 3);
  }
  if (mesh->frame_rate) {
    fuzz_check(mesh->frame_rate->numerator >= 1 && mesh->frame_rate->denominator >= 1);
  }
}

}  // namespace rlpc
