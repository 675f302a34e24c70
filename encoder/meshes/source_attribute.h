// Attributes of an input mesh, which do not change from frame to frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/attributes/attribute_set.h"

namespace rlpc {

struct SourceAttribute {
  // kIntegers: `values` are whole numbers, 0 to 2^16 - 1; normalised ones if max_value is set.
  // kNormals: unit vectors of three components.
  enum class Kind : std::uint8_t { kNumbers, kIntegers, kNormals };

  std::string name;  // Table F-1, or another
  AttributeDomain domain = AttributeDomain::kCorner;
  Kind kind = Kind::kNumbers;
  std::uint32_t num_components = 1;  // 1 to 4
  // Of normalised integers: the one that stands for 1, 2^n - 1; otherwise 0.
  std::uint32_t max_value = 0;
  std::vector<float> values{};  // [value][component], all finite
  // Of corners: the index of the value of each, 3 per triangle. Empty: vertices and triangles
  // have their own values, one each.
  std::vector<std::uint32_t> value_of_corner{};

  std::size_t num_values() const { return values.size() / num_components; }
};

// What materials do with a set of texture coordinates.
struct UvUse {
  // Along the unit of the coordinates, of the longer side of the largest image that they
  // address. 0: of none; infinity: of one of an unknown size, as of other types than PNG and
  // JPEG.
  double texels = 0.0;
  // Images along that unit, by KHR_texture_transform; at least 1.
  double scale = 1.0;
};

// Normals of a frame, as first_normals below.
struct PosedNormals {
  std::uint32_t frame = 0;
  std::vector<float> normals;
};

struct SourceAttributes {
  std::vector<SourceAttribute> sets;
  // The shape to which `normal` belongs, if that is not the first frame: positions, and for
  // each corner the index of its one.
  std::vector<float> rest_xyz{};
  std::vector<std::uint32_t> rest_of_corner{};
  // [value of normal][3], those of the first frame, of length 1 or zero, if they are not those
  // of the values and the input says what moves them; otherwise empty.
  std::vector<float> first_normals{};
  // The same of some later frames, ascending, in which the ways to code normals are compared:
  // each part of the mesh is there in the first or in one of these, if it is in any frame.
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

// What the numbers of `material` and `part` stand for, where the input says so.
struct SourceMaterials {
  std::vector<std::string> names{};  // [value of `material`]; without the last: no material
  std::vector<std::string> part_names{};  // [value of `part`]
  std::string mtl{};                      // contents of the .mtl files
  std::vector<std::string> textures{};    // image files, as the input names them
};

}  // namespace rlpc
