// Reads the accessors of a glTF document and resolves buffer views to ranges of buffers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/document/buffers.h"
#include "encoder/meshes/gltf/document/json.h"

namespace rlpc {

enum class GltfComponent : std::uint16_t {
  kI8 = 5120,
  kU8 = 5121,
  kI16 = 5122,
  kU16 = 5123,
  kU32 = 5125,
  kF32 = 5126,
};

constexpr std::uint32_t bytes_of(GltfComponent component) {
  if (component <= GltfComponent::kU8) return 1;
  return component <= GltfComponent::kU16 ? 2 : 4;
}

// Elements of a buffer: the first at `offset`, then one every `stride` bytes.
struct GltfRange {
  std::uint32_t buffer = 0;
  std::uint64_t offset = 0;
  std::uint64_t stride = 0;
};

struct GltfAccessor {
  struct Sparse {
    std::uint64_t count = 0;
    GltfComponent index_component = GltfComponent::kU16;
    GltfRange indices;
    GltfRange values;
  };

  std::string type;         // "VEC3"
  std::uint32_t width = 1;  // components per element
  GltfComponent component = GltfComponent::kF32;
  bool normalized = false;
  std::uint64_t count = 0;
  std::optional<GltfRange> base;  // none: zeros
  std::optional<Sparse> sparse;   // elements that replace those of the base
};

// If there are no errors, all accessors lie within their buffers.
std::vector<GltfAccessor> read_gltf_accessors(const GltfValue& root,
                                              const std::vector<GltfBuffer>& buffers,
                                              GltfErrors& errors);

}  // namespace rlpc
