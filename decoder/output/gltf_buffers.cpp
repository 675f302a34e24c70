#include "decoder/output/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include "common/io/binary_numbers.h"
#include "decoder/output/mesh_bytes.h"

namespace rlpc {
namespace {

using std::to_string;

constexpr std::uint32_t kMaxShortVertices = 65535;  // index 65535 is reserved in glTF
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kVertexTarget = 34962;
constexpr int kIndexTarget = 34963;

// Minimum and maximum per axis, which accessors of positions must have.
std::string bounds_text(std::span<const float> xyz) {
  std::string min = "\"min\":[";
  std::string max = "\"max\":[";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float low = xyz[axis];
    float high = xyz[axis];
    for (std::size_t i = axis; i < xyz.size(); i += 3) {
      low = std::min(low, xyz[i]);
      high = std::max(high, xyz[i]);
    }
    append_number(min += axis > 0 ? "," : "", low);
    append_number(max += axis > 0 ? "," : "", high);
  }
  return min + "]," + max + "]";
}

std::string accessor_text(int component, std::uint64_t count, const char* type) {
  return "{\"componentType\":" + to_string(component) + ",\"count\":" + to_string(count) +
         ",\"type\":\"" + type + "\"";
}

// Whether a sparse accessor is smaller.
bool is_sparse(std::uint64_t places, std::uint64_t count, std::uint64_t value_bytes) {
  const std::uint64_t index_bytes = count <= kMaxShortVertices ? 2 : 4;
  return places > 0 && places * (index_bytes + value_bytes) < count * value_bytes;
}

void append_index(std::string& bytes, std::uint32_t index, bool is_short) {
  append_u32(bytes, index);
  if (is_short) bytes.resize(bytes.size() - 2);
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

// `target`: bufferView.target; 0: none.
std::uint32_t GltfBuffers::add_view(std::string_view bytes, int target) {
  std::string view = "{\"buffer\":0,\"byteOffset\":" + to_string(chunk_.size()) +
                     ",\"byteLength\":" + to_string(bytes.size());
  if (target != 0) view += ",\"target\":" + to_string(target);
  if (!failure_ && !chunk_.append(bytes)) failure_ = errno;
  return views_.add(view + "}");
}

std::uint32_t GltfBuffers::add_floats(std::span<const float> values, int target) {
  std::string bytes;
  for (const float x : values) append_f32(bytes, x);
  return add_view(bytes, target);
}

// The sparse part of an accessor that is zero except for `values` at `places`.
std::string GltfBuffers::sparse_text(const std::vector<std::uint32_t>& places,
                                     std::uint64_t count, std::span<const float> values) {
  const bool is_short = count <= kMaxShortVertices;
  std::string bytes;
  for (const std::uint32_t place : places) append_index(bytes, place, is_short);
  const std::string indices = to_string(add_view(bytes, 0));
  return ",\"sparse\":{\"count\":" + to_string(places.size()) +
         ",\"indices\":{\"bufferView\":" + indices +
         ",\"componentType\":" + to_string(is_short ? kUnsignedShort : kUnsignedInt) +
         "},\"values\":{\"bufferView\":" + to_string(add_floats(values, 0)) + "}}";
}

std::uint32_t GltfBuffers::add_vectors(std::span<const float> xyz) {
  const std::string view = to_string(add_floats(xyz, kVertexTarget));
  return accessors_.add(accessor_text(kFloat, xyz.size() / 3, "VEC3") +
                        ",\"bufferView\":" + view + "," + bounds_text(xyz) + "}");
}

std::optional<std::uint32_t> GltfBuffers::add_moves(std::span<const float> moves) {
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
  if (!is_sparse(moving.size(), count, 12)) return add_vectors(moves);
  const std::string sparse = sparse_text(moving, count, values);
  return accessors_.add(accessor_text(kFloat, count, "VEC3") + "," + bounds_text(moves) +
                        sparse + "}");
}

std::uint32_t GltfBuffers::add_zero_vectors(std::uint32_t count) {
  return accessors_.add(accessor_text(kFloat, count, "VEC3") +
                        ",\"min\":[0,0,0],\"max\":[0,0,0]}");
}

std::uint32_t GltfBuffers::add_indices(const std::vector<Triangle>& triangles,
                                       std::uint32_t num_vertices) {
  const bool is_short = num_vertices <= kMaxShortVertices;
  std::string bytes;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) append_index(bytes, v, is_short);
  }
  const std::string view = to_string(add_view(bytes, kIndexTarget));
  return accessors_.add(accessor_text(is_short ? kUnsignedShort : kUnsignedInt,
                                      3 * std::uint64_t{triangles.size()}, "SCALAR") +
                        ",\"bufferView\":" + view + "}");
}

std::uint32_t GltfBuffers::add_times(std::span<const float> times) {
  const std::string view = to_string(add_floats(times, 0));
  std::string last;
  append_number(last, times.back());
  return accessors_.add(accessor_text(kFloat, times.size(), "SCALAR") +
                        ",\"bufferView\":" + view + ",\"min\":[0],\"max\":[" + last + "]}");
}

std::uint32_t GltfBuffers::add_ones(const std::vector<std::uint32_t>& places,
                                    std::uint64_t count) {
  std::string accessor = accessor_text(kFloat, count, "SCALAR");
  if (is_sparse(places.size(), count, 4)) {
    accessor += sparse_text(places, count, std::vector<float>(places.size(), 1));
  } else {
    std::vector<float> values(static_cast<std::size_t>(count));
    for (const std::uint32_t place : places) values[place] = 1;
    accessor += ",\"bufferView\":" + to_string(add_floats(values, 0));
  }
  return accessors_.add(accessor + "}");
}

}  // namespace rlpc
