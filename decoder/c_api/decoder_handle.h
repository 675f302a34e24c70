// Handle of the decoder in C, and helpers of its functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/c_api/c_handle.h"
#include "common/codec/mesh/skeleton.h"
#include "common/memory/owned.h"
#include "decoder/c_api/rlpc_c_decoder.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/surface/drawn_mesh.h"

namespace rlpc {

// A frame that rlpc_decoder_blend has decoded.
struct BlendFrame {
  std::optional<std::uint32_t> frame;  // none: must be decoded
  Vector<std::int32_t> positions;
  Vector<double> normals;        // [num_normals][3], unit vectors; empty: not computed
  std::uint32_t normals_of = 0;  // rlpc_normal_weight, or 2: the set `normal`
};

// Frames of the last blend, which the next one may reuse.
struct Blend {
  std::array<BlendFrame, 2> frames;
  double weight = 0;                   // weight of the second frame
  std::array<std::size_t, 2> shown{};  // indices in frames: the first and the second
  bool is_shown = false;               // false: rlpc_decoder::positions is the last frame
};

}  // namespace rlpc

// NOLINTNEXTLINE(readability-identifier-naming): its name in C.
struct rlpc_decoder {
  std::optional<rlpc::Decoder> decoder;
  rlpc::Vector<std::int32_t> positions;  // [num_vertices][3], last frame that was converted
  bool has_frame = false;                // whether a frame or a blend has been decoded
  std::uint32_t next_of_frame = 0;       // position() after that frame
  rlpc::Blend blend;
  // Pose of the last call of rlpc_decoder_pose, and the number of skeletons so far.
  std::optional<rlpc::SkeletonPose> pose;
  std::uint32_t num_skeletons = 0;
  std::uint32_t next_of_pose = 0;    // next_of_frame at that call
  rlpc::Vector<double> normal_sums;  // [num_vertices][3], last frame with normals
  // Cached from the first request on. The drawn mesh refers to the attributes.
  std::optional<rlpc::Vector<rlpc::AttributeSet>> attributes;
  std::optional<rlpc::DrawnMesh> drawn;
  std::optional<rlpc::String> asset;
  rlpc::HandleError error;
  bool is_placed = false;
  bool is_allocated = false;  // whether the owner allocated the handle
  rlpc::Owner owner;          // owner of all memory; not set: operator new
};

namespace rlpc {

rlpc_status status_of(Errc code);
// Sets the error of the handle, and returns its status.
rlpc_status fail(rlpc_decoder& handle, const Error& error);
// Returns RLPC_OK if a frame exists; otherwise sets the error of the handle.
rlpc_status check_frame(rlpc_decoder& handle, std::uint32_t frame);
// Returns whether a buffer has exactly the size needed; otherwise sets the error of the handle.
bool check_buffer(rlpc_decoder& handle, const void* buffer, std::size_t num_values,
                  std::size_t wanted);

// Computes the box of the last blend for rlpc_decoder_bounds.
void give_bounds(const rlpc_decoder& handle, float* min, float* max);

struct IndexBuffer {
  void* indices = nullptr;
  std::size_t num_bytes = 0;
  std::uint32_t index_bytes = 0;  // 2 or 4
};
// Writes the indices of triangles, which are below num_vertices.
rlpc_status give_indices(rlpc_decoder& handle, std::span<const Triangle> triangles,
                         std::uint32_t num_vertices, const IndexBuffer& buffer);

}  // namespace rlpc
