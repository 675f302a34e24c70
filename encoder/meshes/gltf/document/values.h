// Reads the contents of accessors of a glTF document. Values must be finite and of a type
// allowed for their use; the first violation is an error.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "encoder/meshes/gltf/document/accessor.h"
#include "encoder/meshes/gltf/document/affine.h"
#include "encoder/meshes/gltf/document/memory.h"

namespace rlpc {

// Displacement of a vertex by a target.
struct GltfDelta {
  std::uint32_t vertex = 0;
  std::array<float, 3> move{};
};

// Functions return empty results after an error.
class GltfValues {
 public:
  enum class Integers : std::uint8_t { kNo, kToo };

  // Limits the values read to `spare_values` plus 16 per byte present: a small document can
  // neither claim much nor repeat the same data many times.
  GltfValues(const std::vector<GltfAccessor>& accessors, GltfBuffers& buffers,
             std::uint64_t spare_values, GltfMemory& memory, GltfErrors& errors);

  const GltfAccessor& accessor(std::uint32_t i) const { return accessors_[i]; }
  // Counts the memory of data built from values.
  GltfMemory& memory() { return memory_; }

  // Returns [count][width]; integers become floats, exactly unless normalised.
  std::vector<float> floats(std::uint32_t accessor, std::string_view type, Integers integers);
  // Returns [count][width], unsigned.
  std::vector<std::uint32_t> integers(std::uint32_t accessor, std::string_view type);
  // Returns the non-zero elements of a VEC3, in ascending order of vertices.
  std::vector<GltfDelta> deltas(std::uint32_t accessor);
  // Returns the elements of a MAT4, whose last row is taken as 0, 0, 0, 1.
  std::vector<Affine> matrices(std::uint32_t accessor);

 private:
  bool has_type(std::uint32_t accessor, std::string_view type) const;
  bool has_float_type(std::uint32_t accessor, std::string_view type, Integers integers) const;
  bool take(std::uint32_t accessor, std::uint64_t elements);
  template <class Visit>
  void each_element(const GltfRange& range, std::uint64_t count, std::size_t size,
                    const Visit& visit);
  template <class Visit>
  void each_sparse(std::uint32_t accessor, const Visit& visit);
  template <class Visit>
  void each(std::uint32_t accessor, const Visit& visit);
  void store_floats(std::uint32_t accessor, std::uint64_t element, const char* bytes,
                    std::span<float> out);

  const std::vector<GltfAccessor>& accessors_;
  GltfBuffers& buffers_;
  std::uint64_t spare_values_;
  std::uint64_t values_ = 0;
  GltfMemory& memory_;
  GltfErrors& errors_;
};

// Returns "accessors[3]".
std::string gltf_accessor_path(std::uint32_t accessor);

}  // namespace rlpc
