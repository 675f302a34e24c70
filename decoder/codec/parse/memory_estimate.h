// Estimates the memory that decoding takes from the sizes that a stream declares, before any is
// allocated. The constants are upper bounds of what this decoder allocates, including growing
// vectors; conformance/roundtrip/memory_limit_test.cpp compares.
#pragma once

#include <cstdint>

#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// Memory of a stream without GOFs: connectivity, topology, layers (Main and High profile), the
// order of rest positions (High profile), and frames_held frames.
inline std::uint64_t memory_of_stream(const SequenceHeader& header, std::uint32_t frames_held) {
  const std::uint64_t layer_bytes = header.has_skinned_gofs() ? 300 : 0;
  const std::uint64_t rest_order_bytes = header.profile_idc >= kProfileHigh ? 200 : 0;
  const std::uint64_t vertex_bytes =
      100 + layer_bytes + rest_order_bytes + std::uint64_t{12} * frames_held;
  return header.num_vertices * vertex_bytes + std::uint64_t{header.num_triangles} * 120;
}

// Additional memory of a coarse mesh (8.9.8): layers and the triangles of all coarse meshes
// while it is made, then the mesh itself.
inline std::uint64_t memory_of_coarse_mesh(const SequenceHeader& header) {
  constexpr std::uint64_t kBytesPerVertex = 300;
  constexpr std::uint64_t kBytesPerTriangle = 260;
  return header.num_vertices * kBytesPerVertex + header.num_triangles * kBytesPerTriangle;
}

}  // namespace rlpc
