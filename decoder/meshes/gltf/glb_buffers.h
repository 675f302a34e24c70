// Binary part of a glTF file, and the JSON arrays that describe it: buffer views and accessors.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "decoder/meshes/stream_asset.h"

namespace rlpc {

// Binary chunk in an unnamed temporary file: the JSON chunk precedes it, but is known only at
// the end.
class BinaryChunk {
 public:
  BinaryChunk() : file_(std::tmpfile()) {}
  BinaryChunk(const BinaryChunk&) = delete;
  BinaryChunk& operator=(const BinaryChunk&) = delete;
  ~BinaryChunk();

  std::uint64_t size() const { return size_; }
  // Appends bytes at a multiple of 4. Returns false on failure: see errno.
  bool append(std::string_view bytes);
  bool rewind() { return std::fseek(file_, 0, SEEK_SET) == 0; }
  std::size_t read(std::span<char> bytes) {
    return std::fread(bytes.data(), 1, bytes.size(), file_);
  }

 private:
  std::FILE* file_;
  std::uint64_t size_ = 0;
};

// Unit of normalised 16-bit integers.
inline constexpr float kShortUnit = 1.0F / 32767;

// Each add_*() appends values to the chunk and returns the index of their accessor.
class GlbBuffers {
 public:
  // xyz: [num_vertices][3].
  std::uint32_t add_vectors(std::span<const float> xyz);
  // Add unit vectors, and values of 2 to 4 components, per vertex. Texture coordinates between
  // 0 and 1 are rounded to 1/65535.
  std::uint32_t add_normals(std::span<const float> xyz);
  std::uint32_t add_texture_coordinates(std::span<const float> uv);
  std::uint32_t add_vertex_values(std::span<const float> values, std::uint32_t width);
  // Adds a file, such as a texture; returns the index of its view.
  std::uint32_t add_image(std::string_view bytes) { return add_view(bytes, 0); }
  // Adds vectors, sparse if that is smaller; none if all are zero.
  std::optional<std::uint32_t> add_moves(std::span<const float> moves);
  // Adds vectors of bytes, -127 to 127, in units or in 1/127 units (KHR_mesh_quantization);
  // sparse if that is smaller.
  std::uint32_t add_byte_vectors(std::span<const std::int8_t> xyz, bool in_parts_of_127);
  // Adds zeros, which take no bytes.
  std::uint32_t add_zero_vectors(std::uint32_t count);
  std::uint32_t add_indices(const std::vector<Triangle>& triangles, std::uint32_t num_vertices);
  // Add four influences per vertex: indices of joints below num_joints, and weights, which sum
  // to `whole`, 255 or 65535.
  std::uint32_t add_joints(std::span<const std::uint16_t> joints, std::uint32_t num_joints);
  std::uint32_t add_joint_weights(std::span<const std::uint16_t> weights, int whole);
  // times: seconds, ascending, the first 0.
  std::uint32_t add_times(std::span<const float> times);
  // values: [num_matrices][16].
  std::uint32_t add_matrices(std::span<const float> values);
  // Adds values of animations. type: "SCALAR", "VEC3" or "VEC4".
  std::uint32_t add_values(std::span<const float> values, const char* type);
  // Adds values of animations from -1 to 1, rounded to multiples of kShortUnit.
  std::uint32_t add_short_values(std::span<const float> values, const char* type);
  // Adds `count` numbers: 1 at `places`, which ascend, otherwise 0; sparse if that is smaller.
  std::uint32_t add_ones(const std::vector<std::uint32_t>& places, std::uint64_t count);

  const GltfJson& accessors() const { return accessors_; }
  const GltfJson& views() const { return views_; }
  BinaryChunk& chunk() { return chunk_; }
  const BinaryChunk& chunk() const { return chunk_; }
  // Returns errno of the first failure to append to the chunk, which then stays as it is; none
  // without a failure.
  std::optional<int> failure() const { return failure_; }

 private:
  std::uint32_t add_view(std::string_view bytes, int target);
  std::uint32_t add_packed(GltfJson accessor, std::string bytes);
  std::uint32_t add_floats(std::span<const float> values, int target);
  std::uint32_t add_accessor(GltfJson accessor);
  GltfJson sparse(const std::vector<std::uint32_t>& places, std::uint64_t count,
                  std::string_view values);

  BinaryChunk chunk_;
  GltfJson views_ = GltfJson::array();
  GltfJson accessors_ = GltfJson::array();
  std::optional<std::uint32_t> packed_view_;  // last view, if it holds values of animations
  std::optional<int> failure_;
};

}  // namespace rlpc
