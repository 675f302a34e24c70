// The handle of the decoder in C, and what its functions share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/c_api/c_handle.h"
#include "common/codec/mesh/skeleton.h"
#include "common/memory/owned.h"
#include "decoder/c_api/rlpc_decode.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/surface/drawn_mesh.h"

namespace rlpc {

// A frame that rlpc_decoder_blend has decoded.
struct BlendFrame {
  std::optional<std::uint32_t> frame;  // none: it has to be decoded
  Vector<std::int32_t> positions;
  Vector<double> normals;  // of length 1, as many as normals_of says; empty: not computed
  std::uint32_t normals_of = 0;
};

// The frames of the last blend, of which the next one may use one or both.
struct Blend {
  std::array<BlendFrame, 2> frames;
  double weight = 0;                   // of the second
  std::array<std::size_t, 2> shown{};  // of frames: the first and the second
  bool is_shown = false;               // rather than rlpc_decoder::positions
};

}  // namespace rlpc

// NOLINTNEXTLINE(readability-identifier-naming): its name in C.
struct rlpc_decoder {
  std::optional<rlpc::Decoder> decoder;
  rlpc::Vector<std::int32_t> positions;  // of the last frame that was converted
  bool has_frame = false;                // whether there is one, or a blend
  std::uint32_t next_of_frame = 0;       // position() after it
  rlpc::Blend blend;
  // Bones of the frame that was asked for last, and how many skeletons there were up to it.
  std::optional<rlpc::SkeletonPose> pose;
  std::uint32_t num_skeletons = 0;
  std::uint32_t next_of_pose = 0;
  rlpc::Vector<double> normal_sums;  // [num_vertices][3], of the last frame with normals
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

// The box of the blend that is shown, as rlpc_decoder_bounds gives it.
void give_bounds(const rlpc_decoder& handle, float* least, float* most);

struct IndexBuffer {
  void* indices = nullptr;
  std::size_t num_bytes = 0;
  std::uint32_t index_bytes = 0;  // 2 or 4
};
// Writes the indices of triangles, which are below num_vertices.
rlpc_status give_indices(rlpc_decoder& handle, std::span<const Triangle> triangles,
                         std::uint32_t num_vertices, const IndexBuffer& buffer);

}  // namespace rlpc
