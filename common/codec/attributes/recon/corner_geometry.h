// Geometry of triangles in the first frame, as integers (F.7.3, F.8).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/codec/bits/int_math.h"
#include "common/codec/mesh/corners.h"
#include "common/codec/mesh/mesh.h"

namespace rlpc {

inline constexpr int kCornerFractionBits = 12;  // places along an edge, and ratios

inline std::int64_t dot(const Vec3l& a, const Vec3l& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

class CornerGeometry {
 public:
  // positions: [num_vertices][3], |x| < 2^23. Both spans must outlive it.
  CornerGeometry(std::span<const Triangle> triangles, std::span<const std::int32_t> positions)
      : triangles_(triangles), positions_(positions) {}

  std::span<const Triangle> triangles() const { return triangles_; }
  // CornerDifferences( ): differences from corner `from` to N others, all shifted by the same
  // number of bits to at most 2^14.
  template <std::size_t N>
  std::array<Vec3l, N> differences(std::uint32_t from,
                                   const std::array<std::uint32_t, N>& to) const {
    std::array<Vec3l, N> all{};
    std::int64_t largest = 1;
    for (std::size_t i = 0; i < N; ++i) {
      all[i] = difference(from, to[i]);
      for (const std::int64_t x : all[i]) largest = std::max(largest, x < 0 ? -x : x);
    }
    const int shift = std::max(floor_log2(static_cast<std::uint64_t>(largest)) - 13, 0);
    for (Vec3l& v : all) {
      for (std::int64_t& x : v) x = round2(x, shift);
    }
    return all;
  }
  // TriangleNormal( t ): a vector as long as twice the area.
  Vec3l triangle_normal(std::uint32_t t) const;
  // IsLongestEdge( c )
  bool is_longest_edge(std::uint32_t c) const;
  // IsLikelyDiagonal( c, d )
  bool is_likely_diagonal(std::uint32_t c, std::uint32_t mate) const;
  // AngleAt( c ), in units of 2^-13 radian.
  std::int64_t angle_at(std::uint32_t c) const;

 private:
  std::span<const std::int32_t> at(std::uint32_t c) const {
    return positions_.subspan(3 * std::size_t{vertex_of_corner(triangles_, c)}, 3);
  }
  Vec3l difference(std::uint32_t from, std::uint32_t to) const {
    const auto a = at(from);
    const auto b = at(to);
    return {std::int64_t{b[0]} - a[0], std::int64_t{b[1]} - a[1], std::int64_t{b[2]} - a[2]};
  }
  std::int64_t edge_length(std::uint32_t c) const {
    const Vec3l edge = difference(c, next_corner(c));
    return dot(edge, edge);
  }

  std::span<const Triangle> triangles_;
  std::span<const std::int32_t> positions_;
};

// Along( v, edge, length ) and Height( v, edge, length ): length is Dot( edge, edge ), not 0.
std::int64_t place_along(const Vec3l& v, const Vec3l& edge, std::int64_t length);
std::int64_t height_above(const Vec3l& v, const Vec3l& edge, std::int64_t length);

}  // namespace rlpc
