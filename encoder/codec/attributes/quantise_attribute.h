// Values of an input attribute as the integers of a set.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "encoder/codec/attributes/attribute_settings.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

struct QuantisedAttribute {
  AttributeHeader header;             // prediction not set
  std::vector<std::uint32_t> values;  // [value][component]; floats as ordered bits
};

QuantisedAttribute quantise_attribute(const SourceAttribute& source,
                                      const AttributeSettings& settings);

// The point of the octahedron nearest in angle to a normal; value_bits: 2 to 16.
std::array<std::uint32_t, 2> octahedron_point(const std::array<double, 3>& normal,
                                              std::uint32_t value_bits);
// The unit vector of a point.
std::array<double, 3> octahedron_vector(const std::array<std::uint32_t, 2>& point,
                                        std::uint32_t value_bits);

}  // namespace rlpc
