#include "decoder/c_api/convert_frame.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "common/files/float_position.h"
#include "common/memory/owned.h"
#include "decoder/c_api/vector3.h"
#include "decoder/surface/attribute_values.h"

namespace rlpc {
namespace {

std::size_t bytes_of(std::uint32_t format) {
  switch (format) {
    case RLPC_FORMAT_INT32:
    case RLPC_FORMAT_FLOAT:
      return 4;
    case RLPC_FORMAT_HALF:
    case RLPC_FORMAT_INT16:
      return 2;
    default:
      return 1;
  }
}

std::size_t stride_of(const rlpc_channel& channel) {
  return channel.stride == 0 ? 3 * bytes_of(channel.format) : channel.stride;
}

// Writes values. value(v, c): of vertex v and axis c.
template <class Value>
void write(const rlpc_channel& channel, std::size_t count, const Value& value) {
  auto* const first = static_cast<unsigned char*>(channel.data);
  const std::size_t stride = stride_of(channel);
  for (std::size_t v = 0; v < count; ++v) {
    const std::array values{value(v, 0), value(v, 1), value(v, 2)};
    // Computes no place past the last vertex: it may lie outside the buffer.
    std::memcpy(first + v * stride, values.data(), sizeof values);
  }
}

template <class Int>
Int rounded(double value) {
  const double max = std::numeric_limits<Int>::max();
  const double min = std::numeric_limits<Int>::min();
  return static_cast<Int>(std::nearbyint(std::clamp(value, min, max)));
}

}  // namespace

std::uint16_t half_of(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  const std::uint32_t sign = (bits >> 16) & 0x8000U;
  const std::uint32_t magnitude = bits & 0x7FFFFFFFU;
  constexpr std::uint32_t kInfinity = 0x7C00;
  constexpr std::uint32_t kTooLarge = 0x477FF000;  // 65520, which rounds to infinity
  if (magnitude >= kTooLarge) return static_cast<std::uint16_t>(sign | kInfinity);
  constexpr std::uint32_t kSmallestNormal = 0x38800000;  // 2^-14
  std::uint32_t kept = 0;
  std::uint32_t dropped_bits = 13;
  if (magnitude >= kSmallestNormal) {
    kept = magnitude - 0x38000000U;  // exponent bias of 15 instead of 127
  } else {
    const std::uint32_t exponent = magnitude >> 23;
    constexpr std::uint32_t kBelowHalfOfSmallest = 101;  // exponent of values below 2^-25
    if (exponent <= kBelowHalfOfSmallest) return static_cast<std::uint16_t>(sign);
    kept = (magnitude & 0x7FFFFFU) | 0x800000U;
    dropped_bits += 113 - exponent;
  }
  const std::uint32_t half = std::uint32_t{1} << (dropped_bits - 1);
  const std::uint32_t odd = (kept >> dropped_bits) & 1U;
  return static_cast<std::uint16_t>(sign | ((kept + half - 1 + odd) >> dropped_bits));
}

std::size_t bytes_needed(const rlpc_channel& channel, std::size_t count) {
  return (count - 1) * stride_of(channel) + 3 * bytes_of(channel.format);
}

Int16Scale int16_scale(const Grid& grid, int position_bits) {
  Int16Scale result;
  const int dropped_bits = std::max(position_bits - 16, 0);
  const double step = std::ldexp(1.0, grid.log2_step);
  for (std::size_t c = 0; c < 3; ++c) {
    result.scale[c] = std::ldexp(step, dropped_bits);
    result.offset[c] = grid.origin[c] * step;
  }
  return result;
}

void write_positions(const Triples<std::int32_t>& positions, const Grid& grid,
                     const Int16Scale& scale, const rlpc_channel& channel) {
  const std::size_t count = positions.num_vertices();
  const auto as_float = [&](std::size_t v, std::size_t c) {
    return float_position(grid, c, positions.at(v)[c]);
  };
  switch (channel.format) {
    case RLPC_FORMAT_INT32:
      write(channel, count, [&](std::size_t v, std::size_t c) { return positions.at(v)[c]; });
      break;
    case RLPC_FORMAT_FLOAT:
      write(channel, count, as_float);
      break;
    case RLPC_FORMAT_HALF:
      write(channel, count,
            [&](std::size_t v, std::size_t c) { return half_of(as_float(v, c)); });
      break;
    default: {
      const double step = std::ldexp(1.0, grid.log2_step);
      write(channel, count, [&](std::size_t v, std::size_t c) {
        const double coordinate =
            (static_cast<double>(positions.at(v)[c]) + grid.origin[c]) * step;
        return rounded<std::int16_t>((coordinate - scale.offset[c]) / scale.scale[c]);
      });
    }
  }
}

float float_position(const Grid& grid, std::size_t axis, double position) {
  return static_cast<float>(std::ldexp(position + grid.origin[axis], grid.log2_step));
}

void write_mixed_positions(const Mix<std::int32_t>& positions, const Grid& grid,
                           const Int16Scale& scale, const rlpc_channel& channel) {
  const std::size_t count = positions.first.num_vertices();
  const auto as_float = [&](std::size_t v, std::size_t c) {
    return float_position(grid, c, positions.at(v, c));
  };
  switch (channel.format) {
    case RLPC_FORMAT_FLOAT:
      write(channel, count, as_float);
      break;
    case RLPC_FORMAT_HALF:
      write(channel, count,
            [&](std::size_t v, std::size_t c) { return half_of(as_float(v, c)); });
      break;
    default:
      write(channel, count, [&](std::size_t v, std::size_t c) {
        const double coordinate =
            std::ldexp(positions.at(v, c) + grid.origin[c], grid.log2_step);
        return rounded<std::int16_t>((coordinate - scale.offset[c]) / scale.scale[c]);
      });
  }
}

namespace {

// Writes normals. normal(v): unit vector of vertex v.
template <class Normal>
void write_unit_normals(const rlpc_channel& channel, std::size_t count, const Normal& normal) {
  const auto write_as = [&](const auto& convert) {
    Vec3d unit{};
    write(channel, count, [&](std::size_t v, std::size_t c) {
      if (c == 0) unit = normal(v);
      return convert(unit[c]);
    });
  };
  switch (channel.format) {
    case RLPC_FORMAT_FLOAT:
      write_as([](double x) { return static_cast<float>(x); });
      break;
    case RLPC_FORMAT_HALF:
      write_as([](double x) { return half_of(static_cast<float>(x)); });
      break;
    case RLPC_FORMAT_INT16:
      write_as([](double x) { return rounded<std::int16_t>(32767 * x); });
      break;
    default:
      write_as([](double x) { return rounded<std::int8_t>(127 * x); });
  }
}

}  // namespace

void write_normals(const Triples<double>& sums, const rlpc_channel& channel) {
  write_unit_normals(channel, sums.num_vertices(),
                     [&](std::size_t v) { return unit_normal(sums.at(v)); });
}

void write_mixed_normals(const Mix<double>& normals, const rlpc_channel& channel) {
  constexpr double kShortest = 1e-6;  // shortest sum of unit vectors with a direction
  write_unit_normals(channel, normals.first.num_vertices(), [&](std::size_t v) {
    const Vec3d sum{normals.at(v, 0), normals.at(v, 1), normals.at(v, 2)};
    if (dot(sum, sum) > kShortest * kShortest) return unit_normal(sum.data());
    return unit_normal(normals.weight > 0.5 ? normals.second.at(v) : normals.first.at(v));
  });
}

void sum_normals(std::span<const std::int32_t> positions, std::span<const Triangle> triangles,
                 bool by_angle, rlpc::Vector<double>& sums) {
  sums.assign(positions.size(), 0);
  for (const Triangle& t : triangles) {
    std::array<Vec3d, 3> edges{};  // from corner k to the next
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t* const from = &positions[3 * std::size_t{t[k]}];
      const std::int32_t* const to = &positions[3 * std::size_t{t[(k + 1) % 3]}];
      for (std::size_t c = 0; c < 3; ++c) edges[k][c] = static_cast<double>(to[c]) - from[c];
    }
    const Vec3d normal = cross(edges[0], edges[1]);  // as long as twice the area
    const double length = std::sqrt(dot(normal, normal));
    if (!(length > 0)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      // The angle between this edge and the reversed previous edge.
      const double weight =
          by_angle ? std::atan2(length, -dot(edges[k], edges[(k + 2) % 3])) / length : 1;
      double* const sum = &sums[3 * std::size_t{t[k]}];
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * normal[c];
    }
  }
}

}  // namespace rlpc
