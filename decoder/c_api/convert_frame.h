// Positions and normals of a frame in the forms of rlpc_frame_output.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"
#include "decoder/c_api/rlpc_frame_output.h"

namespace rlpc {

// Returns the nearest binary16, ties to even; infinity beyond its range.
std::uint16_t half_of(float value);

// Returns the bytes from the first value to the last of `count` vertices.
std::size_t bytes_needed(const rlpc_channel& channel, std::size_t count);

// coordinate = value * scale + offset
struct Int16Scale {
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
};
// Returns the scale with which 16 bits cover every position of position_bits bits.
Int16Scale int16_scale(const Grid& grid, int position_bits);

// Triples of numbers [i][3], and the index of the triple of each output vertex; vertex_of_drawn
// is empty if vertex i has triple i.
template <class Number>
struct Triples {
  std::span<const Number> numbers;
  std::span<const std::uint32_t> vertex_of_drawn;

  std::size_t num_vertices() const {
    return vertex_of_drawn.empty() ? numbers.size() / 3 : vertex_of_drawn.size();
  }
  const Number* at(std::size_t vertex) const {
    return &numbers[3 *
                    (vertex_of_drawn.empty() ? vertex : std::size_t{vertex_of_drawn[vertex]})];
  }
};

// Values of two frames with the same vertices, and the weight of the second, 0 to 1.
template <class Number>
struct Mix {
  Triples<Number> first;
  Triples<Number> second;
  double weight = 0;

  double at(std::size_t vertex, std::size_t c) const {
    return (1 - weight) * first.at(vertex)[c] + weight * second.at(vertex)[c];
  }
};
// Returns the coordinate of a position between grid points, rounded once.
float float_position(const Grid& grid, std::size_t axis, double position);

// The functions below write bytes_needed() at most. The format has been checked.
//
// Writes positions, in grid units.
void write_positions(const Triples<std::int32_t>& positions, const Grid& grid,
                     const Int16Scale& scale, const rlpc_channel& channel);
// Writes interpolated positions; the format is not RLPC_FORMAT_INT32.
void write_mixed_positions(const Mix<std::int32_t>& positions, const Grid& grid,
                           const Int16Scale& scale, const rlpc_channel& channel);
// Writes normals as unit vectors. sums: vectors of any length.
void write_normals(const Triples<double>& sums, const rlpc_channel& channel);
// Writes interpolated normals. normals: unit vectors; where they cancel out, the one with the
// larger weight is written.
void write_mixed_normals(const Mix<double>& normals, const rlpc_channel& channel);

// Sums the normals of the triangles around each vertex, weighted by area or by angle.
void sum_normals(std::span<const std::int32_t> positions, std::span<const Triangle> triangles,
                 bool by_angle, rlpc::Vector<double>& sums);

}  // namespace rlpc
