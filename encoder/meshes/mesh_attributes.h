// Converts attributes of mesh files to the conventions of Table F-1: texture coordinates with v
// pointing down instead of up, colours linear instead of sRGB, normals of length 1.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

// Marks corners without a value of their own.
inline constexpr std::uint32_t kNoValue = 0xFFFFFFFF;

// Makes texture coordinates of corners if value_of_corner is not empty, otherwise of vertices.
// Corners without a value get (0, 0), in the convention of the file.
//
// uv: [value][2]
SourceAttribute uv_attribute(std::vector<float> uv, std::vector<std::uint32_t> value_of_corner);

// Makes normals. Corners without a normal, or with one of length 0, get that of their triangle;
// vertices with one of length 0 get (0, 0, 1).
//
// normals: [value][3]
// xyz: positions of the vertices
SourceAttribute normal_attribute(std::vector<float> normals,
                                 std::vector<std::uint32_t> value_of_corner,
                                 std::span<const float> xyz,
                                 std::span<const Triangle> triangles);

// values: [value][num_components], 0 to 1, sRGB; a fourth component is opacity. are_bytes: they
// are multiples of 1/255, which rlpcdec then restores.
SourceAttribute colour_attribute(std::vector<float> values, std::uint32_t num_components,
                                 bool are_bytes, std::vector<std::uint32_t> value_of_corner);
// Whether all values are in the range of colour_attribute().
bool are_colours(std::span<const float> values);

// Makes integers of triangles, at most 65535 each; none if all of them are the same.
std::optional<SourceAttribute> triangle_attribute(const std::string& name,
                                                  std::span<const std::uint32_t> numbers);

}  // namespace rlpc
