// Attributes of an input mesh, which do not change from frame to frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/attributes/attribute_set.h"

namespace rlpc {

struct SourceAttribute {
  // kIntegers: `values` are whole numbers, 0 to 2^16 - 1, normalised if max_value is set.
  // kNormals: unit vectors of three components.
  enum class Kind : std::uint8_t { kNumbers, kIntegers, kNormals };

  std::string name;  // Table F-1, or another
  AttributeDomain domain = AttributeDomain::kCorner;
  Kind kind = Kind::kNumbers;
  std::uint32_t num_components = 1;  // 1 to 4
  // The number that means 1 in normalised integers, 2^n - 1; otherwise 0.
  std::uint32_t max_value = 0;
  std::vector<float> values{};  // [value][component], all finite
  // Index of the value of each corner, 3 per triangle. Empty: vertices or triangles have one
  // value each.
  std::vector<std::uint32_t> value_of_corner{};

  std::size_t num_values() const { return values.size() / num_components; }
};

// Use of a set of texture coordinates by materials.
struct UvUse {
  // Texels per unit of the coordinates, along the longer side of the largest image that they
  // address. 0: no image; infinity: an image of unknown size, as of other types than PNG and
  // JPEG.
  double texels = 0.0;
  // Repetitions of the image along that unit, by KHR_texture_transform; at least 1.
  double scale = 1.0;
};

// Normals of a frame, like first_normals below.
struct PosedNormals {
  std::uint32_t frame = 0;
  std::vector<float> normals;
};

struct SourceAttributes {
  std::vector<SourceAttribute> sets;
  // Positions of the shape that `normal` belongs to, if that is not the first frame, and for
  // each corner the index of its position.
  std::vector<float> rest_xyz{};
  std::vector<std::uint32_t> rest_of_corner{};
  // [value of normal][3]: normals of the first frame, of length 1 or zero, if they differ from
  // the values and the input says what moves them; otherwise empty.
  std::vector<float> first_normals{};
  // Normals of some later frames, ascending, in which the ways to code normals are compared:
  // each part of the mesh that is visible in any frame is visible in the first or in one of
  // these.
  std::vector<PosedNormals> later_normals{};

  std::uint64_t memory_bytes() const {
    const auto bytes = [](const auto& all) {
      return std::uint64_t{all.capacity()} * sizeof(all[0]);
    };
    std::uint64_t sum = bytes(rest_xyz) + bytes(rest_of_corner) + bytes(first_normals);
    for (const PosedNormals& later : later_normals) sum += bytes(later.normals);
    for (const SourceAttribute& set : sets)
      sum += bytes(set.values) + bytes(set.value_of_corner);
    return sum;
  }
};

// Meaning of the numbers of `material` and `part`, as far as the input states it.
struct SourceMaterials {
  std::vector<std::string> names{};       // [value of `material`]; a value beyond: no material
  std::vector<std::string> part_names{};  // [value of `part`]
  std::string mtl{};                      // contents of the .mtl files
  std::vector<std::string> textures{};    // image files, as the input names them
};

}  // namespace rlpc
