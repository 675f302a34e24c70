// Shared by the fuzz targets of the mesh readers: the properties they check. Files are called
// "fuzz.mesh".
#pragma once

#include <cmath>
#include <cstdint>

#include "common/testing/fuzz_input.h"
#include "encoder/meshes/mesh_reader.h"

namespace rlpc {

inline void check_attribute(const SourceAttribute& set, std::size_t num_vertices,
                            std::size_t num_triangles) {
  fuzz_check(set.num_components >= 1 && set.num_components <= 4);
  fuzz_check(set.values.size() % set.num_components == 0);
  for (const float x : set.values) fuzz_check(std::isfinite(x));
  if (set.kind == SourceAttribute::Kind::kIntegers) {
    for (const float x : set.values) fuzz_check(x >= 0 && x <= 65535 && x == std::floor(x));
  }
  if (set.domain == AttributeDomain::kVertex) fuzz_check(set.num_values() == num_vertices);
  if (set.domain == AttributeDomain::kTriangle) fuzz_check(set.num_values() == num_triangles);
  if (set.domain != AttributeDomain::kCorner) return;
  fuzz_check(set.value_of_corner.size() == 3 * num_triangles);
  for (const std::uint32_t i : set.value_of_corner) fuzz_check(i < set.num_values());
}

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
  for (const SourceAttribute& set : mesh->attributes.sets) {
    check_attribute(set, mesh->xyz.size() / 3, mesh->triangles.size());
  }
  if (mesh->frame_rate) {
    fuzz_check(mesh->frame_rate->numerator >= 1 && mesh->frame_rate->denominator >= 1);
  }
}

}  // namespace rlpc
