// The handle of the decoder in C, and what its functions share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/c_api/c_handle.h"
#include "common/owned.h"
#include "decoder/c_api/rlpc_decode.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/surface/drawn_mesh.h"

// NOLINTNEXTLINE(readability-identifier-naming): its name in C.
struct rlpc_decoder {
  std::optional<rlpc::Decoder> decoder;
  rlpc::Vector<std::int32_t> positions;  // of the last frame that was converted
  bool has_frame = false;                // whether there is one
  rlpc::Vector<double> normal_sums;      // [num_vertices][3], of the last frame with normals
  // Kept once they have been asked for. The drawn mesh refers to the attributes.
  std::optional<rlpc::Vector<rlpc::AttributeSet>> attributes;
  std::optional<rlpc::DrawnMesh> drawn;
  std::optional<rlpc::String> asset;
  rlpc::HandleError error;
  bool is_placed = false;
  bool is_allocated = false;  // by the owner
  rlpc::Owner owner;          // of all its memory; not set: operator new
};

namespace rlpc {

rlpc_status status_of(Errc code);
// Both set the error of the handle.
rlpc_status fail(rlpc_decoder& handle, const Error& error);
rlpc_status check_frame(rlpc_decoder& handle, std::uint32_t frame);
// Whether a buffer has exactly the size needed.
bool check_buffer(rlpc_decoder& handle, const void* buffer, std::size_t num_values,
                  std::size_t wanted);

struct IndexBuffer {
  void* indices = nullptr;
  std::size_t num_bytes = 0;
  std::uint32_t index_bytes = 0;  // 2 or 4
};
// Writes the indices of triangles, which are below num_vertices.
rlpc_status give_indices(rlpc_decoder& handle, std::span<const Triangle> triangles,
                         std::uint32_t num_vertices, const IndexBuffer& buffer);

}  // namespace rlpc
