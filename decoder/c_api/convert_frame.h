// Positions and normals of a frame in the forms of rlpc_frame_output.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/mesh/mesh.h"
#include "common/owned.h"
#include "decoder/c_api/rlpc_frame_output.h"

namespace rlpc {

// The nearest binary16, ties to even; infinity beyond its range.
std::uint16_t half_of(float value);

// Bytes from the first value to the last of `count` vertices.
std::size_t bytes_needed(const rlpc_channel& channel, std::size_t count);

// coordinate = value * scale + offset
struct Int16Scale {
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
};
// Holds every position of position_bits.
Int16Scale int16_scale(const Grid& grid, int position_bits);

// Both write bytes_needed() at most. The format has been checked.
//
// positions: [num_vertices][3], grid units
void write_positions(std::span<const std::int32_t> positions, const Grid& grid,
                     const Int16Scale& scale, const rlpc_channel& channel);
// sums: [num_vertices][3], of any length
void write_normals(std::span<const double> sums, const rlpc_channel& channel);

// The sum of the normals of the triangles around each vertex, by area or by angle.
void sum_normals(std::span<const std::int32_t> positions, std::span<const Triangle> triangles,
                 bool by_angle, rlpc::Vector<double>& sums);

}  // namespace rlpc
