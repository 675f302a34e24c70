// Attributes of an input mesh, which do not change from frame to frame.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/attributes/attribute_set.h"

namespace rlpc {

struct SourceAttribute {
  // kIntegers: `values` are whole numbers, 0 to 2^16 - 1; normalised ones if max_value is set.
  // kNormals: unit vectors of three components.
  enum class Kind : std::uint8_t { kNumbers, kIntegers, kNormals };

  std::string name;  // Table F-1, or another
  AttributeDomain domain = AttributeDomain::kCorner;
  Kind kind = Kind::kNumbers;
  std::uint32_t num_components = 1;  // 1 to 4
  // Of normalised integers: 255, or 65535, which stand for 1; otherwise 0.
  std::uint32_t max_value = 0;
  std::vector<float> values{};  // [value][component], all finite
  // Of corners: the index of the value of each, 3 per triangle. Empty: vertices and triangles
  // have their own values, one each.
  std::vector<std::uint32_t> value_of_corner{};

  std::size_t num_values() const { return values.size() / num_components; }
};

struct SourceAttributes {
  std::vector<SourceAttribute> sets;
  // The shape to which `normal` belongs, if that is not the first frame: positions, and for
  // each corner the index of its one.
  std::vector<float> rest_xyz{};
  std::vector<std::uint32_t> rest_of_corner{};
};

}  // namespace rlpc
