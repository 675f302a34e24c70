// Writes attributes exactly, for comparisons (F.9).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/files/output_file.h"

namespace rlpc {

// F.9 The .rlpa format. sets: vertices in output order.
std::string rlpa_bytes(std::uint32_t num_vertices, std::uint32_t num_triangles,
                       const std::vector<AttributeSet>& sets);
// Writes .rlpa as a file, which appears complete or not at all.
std::optional<OutputError> write_rlpa(const std::string& path, std::uint32_t num_vertices,
                                      std::uint32_t num_triangles,
                                      const std::vector<AttributeSet>& sets);

}  // namespace rlpc
