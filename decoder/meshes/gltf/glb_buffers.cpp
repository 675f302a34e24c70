#include "decoder/meshes/gltf/glb_buffers.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <utility>

#include "common/files/binary_numbers.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kMaxShortVertices = 65535;  // index 65535 is reserved in glTF
constexpr std::uint32_t kMaxByteJoints = 256;
constexpr int kByte = 5120;
constexpr int kUnsignedByte = 5121;
constexpr int kShort = 5122;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kVertexTarget = 34962;
constexpr int kIndexTarget = 34963;

GltfJson accessor_of(int component, std::uint64_t count, const char* type) {
  return {{"componentType", component}, {"count", count}, {"type", type}};
}

// Sets minimum and maximum per axis, as accessors of positions require.
template <class T>
void set_bounds(GltfJson& accessor, std::span<const T> xyz) {
  GltfJson min = GltfJson::array();
  GltfJson max = GltfJson::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    T low = xyz[axis];
    T high = xyz[axis];
    for (std::size_t i = axis; i < xyz.size(); i += 3) {
      low = std::min(low, xyz[i]);
      high = std::max(high, xyz[i]);
    }
    min.push_back(low);
    max.push_back(high);
  }
  accessor["min"] = std::move(min);
  accessor["max"] = std::move(max);
}

// JSON bytes of the two views of a sparse accessor.
constexpr std::uint64_t kSparseJsonBytes = 240;

// Returns whether a sparse accessor is smaller. The bytes are those of a value, padded or not.
bool is_sparse(std::uint64_t places, std::uint64_t count, std::uint64_t padded_bytes,
               std::uint64_t value_bytes) {
  const std::uint64_t index_bytes = count <= kMaxShortVertices ? 2 : 4;
  return places > 0 &&
         places * (index_bytes + value_bytes) + kSparseJsonBytes < count * padded_bytes;
}

std::string bytes_of_floats(std::span<const float> values) {
  std::string bytes;
  for (const float x : values) append_f32(bytes, x);
  return bytes;
}

// Appends the lowest `bytes` bytes of a number.
void append_unsigned(std::string& text, std::uint32_t value, std::size_t bytes) {
  append_u32(text, value);
  text.resize(text.size() - (4 - bytes));
}

std::string bytes_of_shorts(std::span<const float> values) {
  std::string bytes;
  for (const float x : values) {
    append_unsigned(bytes, static_cast<std::uint32_t>(std::lround(x / kShortUnit)), 2);
  }
  return bytes;
}

std::size_t width_of(std::string_view type) {
  return type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
}

}  // namespace

BinaryChunk::~BinaryChunk() {
  if (file_ != nullptr) std::fclose(file_);
}

bool BinaryChunk::append(std::string_view bytes) {
  constexpr std::array<char, 4> kZeros{};
  const std::size_t padding = (4 - bytes.size() % 4) % 4;
  size_ += bytes.size() + padding;
  return file_ != nullptr &&
         std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size() &&
         std::fwrite(kZeros.data(), 1, padding, file_) == padding;
}

// Adds a view. target: bufferView.target; 0: none.
std::uint32_t GlbBuffers::add_view(std::string_view bytes, int target) {
  GltfJson view = {{"buffer", 0}, {"byteOffset", chunk_.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  if (!failure_ && !chunk_.append(bytes)) failure_ = errno;
  views_.push_back(std::move(view));
  packed_view_.reset();
  return static_cast<std::uint32_t>(views_.size() - 1);
}

std::uint32_t GlbBuffers::add_floats(std::span<const float> values, int target) {
  return add_view(bytes_of_floats(values), target);
}

std::uint32_t GlbBuffers::add_accessor(GltfJson accessor) {
  accessors_.push_back(std::move(accessor));
  return static_cast<std::uint32_t>(accessors_.size() - 1);
}

// Returns the sparse part of an accessor that is zero except for `values` at `places`.
GltfJson GlbBuffers::sparse(const std::vector<std::uint32_t>& places, std::uint64_t count,
                            std::string_view values) {
  const bool is_short = count <= kMaxShortVertices;
  std::string bytes;
  for (const std::uint32_t place : places) append_unsigned(bytes, place, is_short ? 2 : 4);
  const std::uint32_t indices = add_view(bytes, 0);
  return {
      {"count", places.size()},
      {"indices",
       {{"bufferView", indices}, {"componentType", is_short ? kUnsignedShort : kUnsignedInt}}},
      {"values", {{"bufferView", add_view(values, 0)}}}};
}

std::uint32_t GlbBuffers::add_vectors(std::span<const float> xyz) {
  GltfJson accessor = accessor_of(kFloat, xyz.size() / 3, "VEC3");
  accessor["bufferView"] = add_floats(xyz, kVertexTarget);
  set_bounds<float>(accessor, xyz);
  return add_accessor(std::move(accessor));
}

std::uint32_t GlbBuffers::add_normals(std::span<const float> xyz) {
  return add_vertex_values(xyz, 3);
}

std::uint32_t GlbBuffers::add_vertex_values(std::span<const float> values,
                                            std::uint32_t width) {
  const std::string type = "VEC" + std::to_string(width);
  GltfJson accessor = accessor_of(kFloat, values.size() / width, type.c_str());
  accessor["bufferView"] = add_floats(values, kVertexTarget);
  return add_accessor(std::move(accessor));
}

std::uint32_t GlbBuffers::add_texture_coordinates(std::span<const float> uv) {
  const auto is_outside = [](float x) { return !(x >= 0 && x <= 1); };
  if (std::ranges::any_of(uv, is_outside)) return add_vertex_values(uv, 2);
  std::string bytes;
  for (const float x : uv) {
    append_unsigned(bytes, static_cast<std::uint32_t>(std::lround(x * 65535)), 2);
  }
  GltfJson accessor = accessor_of(kUnsignedShort, uv.size() / 2, "VEC2");
  accessor["normalized"] = true;
  accessor["bufferView"] = add_view(bytes, kVertexTarget);
  return add_accessor(std::move(accessor));
}

std::optional<std::uint32_t> GlbBuffers::add_moves(std::span<const float> moves) {
  const std::uint64_t count = moves.size() / 3;
  std::vector<std::uint32_t> moving;
  std::vector<float> values;
  for (std::uint32_t v = 0; v < count; ++v) {
    const auto move = moves.subspan(3 * std::size_t{v}, 3);
    if (move[0] == 0 && move[1] == 0 && move[2] == 0) continue;
    moving.push_back(v);
    values.insert(values.end(), move.begin(), move.end());
  }
  if (moving.empty()) return std::nullopt;
  if (!is_sparse(moving.size(), count, 12, 12)) return add_vectors(moves);
  GltfJson accessor = accessor_of(kFloat, count, "VEC3");
  set_bounds<float>(accessor, moves);
  accessor["sparse"] = sparse(moving, count, bytes_of_floats(values));
  return add_accessor(std::move(accessor));
}

std::uint32_t GlbBuffers::add_byte_vectors(std::span<const std::int8_t> xyz,
                                           bool in_parts_of_127) {
  const std::uint64_t count = xyz.size() / 3;
  std::vector<std::uint32_t> places;
  std::string values;
  std::string padded;  // each vertex begins at a multiple of 4
  for (std::uint32_t v = 0; v < count; ++v) {
    const auto position = xyz.subspan(3 * std::size_t{v}, 3);
    const std::string bytes(position.begin(), position.end());
    padded += bytes;
    padded += '\0';
    if (std::ranges::count(position, 0) == 3) continue;
    places.push_back(v);
    values += bytes;
  }
  GltfJson accessor = accessor_of(kByte, count, "VEC3");
  if (in_parts_of_127) accessor["normalized"] = true;
  if (is_sparse(places.size(), count, 4, 3)) {
    accessor["sparse"] = sparse(places, count, values);
  } else {
    const std::uint32_t view = add_view(padded, kVertexTarget);
    views_[view]["byteStride"] = 4;
    accessor["bufferView"] = view;
  }
  set_bounds(accessor, xyz);
  return add_accessor(std::move(accessor));
}

std::uint32_t GlbBuffers::add_zero_vectors(std::uint32_t count) {
  GltfJson accessor = accessor_of(kFloat, count, "VEC3");
  accessor["min"] = {0, 0, 0};
  accessor["max"] = {0, 0, 0};
  return add_accessor(std::move(accessor));
}

std::uint32_t GlbBuffers::add_indices(const std::vector<Triangle>& triangles,
                                      std::uint32_t num_vertices) {
  const bool is_short = num_vertices <= kMaxShortVertices;
  std::string bytes;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) append_unsigned(bytes, v, is_short ? 2 : 4);
  }
  GltfJson accessor = accessor_of(is_short ? kUnsignedShort : kUnsignedInt,
                                  3 * std::uint64_t{triangles.size()}, "SCALAR");
  accessor["bufferView"] = add_view(bytes, kIndexTarget);
  return add_accessor(std::move(accessor));
}

std::uint32_t GlbBuffers::add_joints(std::span<const std::uint16_t> joints,
                                     std::uint32_t num_joints) {
  const bool is_byte = num_joints <= kMaxByteJoints;
  std::string bytes;
  for (const std::uint16_t joint : joints) append_unsigned(bytes, joint, is_byte ? 1 : 2);
  GltfJson accessor =
      accessor_of(is_byte ? kUnsignedByte : kUnsignedShort, joints.size() / 4, "VEC4");
  accessor["bufferView"] = add_view(bytes, kVertexTarget);
  return add_accessor(std::move(accessor));
}

std::uint32_t GlbBuffers::add_joint_weights(std::span<const std::uint16_t> weights, int whole) {
  const bool is_byte = whole <= 255;
  std::string bytes;
  for (const std::uint16_t weight : weights) append_unsigned(bytes, weight, is_byte ? 1 : 2);
  GltfJson accessor =
      accessor_of(is_byte ? kUnsignedByte : kUnsignedShort, weights.size() / 4, "VEC4");
  accessor["normalized"] = true;
  accessor["bufferView"] = add_view(bytes, kVertexTarget);
  return add_accessor(std::move(accessor));
}

// Adds values of animations, which share one view, each at a multiple of 4.
std::uint32_t GlbBuffers::add_packed(GltfJson accessor, std::string bytes) {
  bytes.resize((bytes.size() + 3) / 4 * 4);
  if (packed_view_) {
    GltfJson& length = views_[*packed_view_]["byteLength"];
    accessor["bufferView"] = *packed_view_;
    accessor["byteOffset"] = length;
    length = length.get<std::uint64_t>() + bytes.size();
    if (!failure_ && !chunk_.append(bytes)) failure_ = errno;
  } else {
    const std::uint32_t view = add_view(bytes, 0);
    accessor["bufferView"] = view;
    packed_view_ = view;
  }
  return add_accessor(std::move(accessor));
}

std::uint32_t GlbBuffers::add_times(std::span<const float> times) {
  GltfJson accessor = accessor_of(kFloat, times.size(), "SCALAR");
  accessor["min"] = {times.front()};
  accessor["max"] = {times.back()};
  return add_packed(std::move(accessor), bytes_of_floats(times));
}

std::uint32_t GlbBuffers::add_values(std::span<const float> values, const char* type) {
  return add_packed(accessor_of(kFloat, values.size() / width_of(type), type),
                    bytes_of_floats(values));
}

std::uint32_t GlbBuffers::add_short_values(std::span<const float> values, const char* type) {
  GltfJson accessor = accessor_of(kShort, values.size() / width_of(type), type);
  accessor["normalized"] = true;
  return add_packed(std::move(accessor), bytes_of_shorts(values));
}

std::uint32_t GlbBuffers::add_matrices(std::span<const float> values) {
  GltfJson accessor = accessor_of(kFloat, values.size() / 16, "MAT4");
  accessor["bufferView"] = add_floats(values, 0);
  return add_accessor(std::move(accessor));
}

std::uint32_t GlbBuffers::add_ones(const std::vector<std::uint32_t>& places,
                                   std::uint64_t count) {
  GltfJson accessor = accessor_of(kFloat, count, "SCALAR");
  if (is_sparse(places.size(), count, 4, 4)) {
    accessor["sparse"] =
        sparse(places, count, bytes_of_floats(std::vector<float>(places.size(), 1)));
  } else {
    std::vector<float> values(static_cast<std::size_t>(count));
    for (const std::uint32_t place : places) values[place] = 1;
    accessor["bufferView"] = add_floats(values, 0);
  }
  return add_accessor(std::move(accessor));
}

}  // namespace rlpc
