// The handle of the decoder in C, and what its functions share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/c_api/c_handle.h"
#include "common/owned.h"
#include "decoder/c_api/rlpc_decode.h"
#include "decoder/rlpc_decoder.h"

// NOLINTNEXTLINE(readability-identifier-naming): its name in C.
struct rlpc_decoder {
  std::optional<rlpc::Decoder> decoder;
  rlpc::Vector<std::int32_t> positions;  // of the last frame that was converted
  bool has_frame = false;                // whether there is one
  rlpc::Vector<double> normal_sums;      // [num_vertices][3], of the last frame with normals
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

}  // namespace rlpc
