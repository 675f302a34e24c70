#include "common/codec/attributes/recon/corner_geometry.h"

namespace rlpc {
namespace {

constexpr std::int64_t kRightAngle = 12868;  // pi / 2
constexpr int kRatioBits = 15;

// ArcTangent: coefficients of odd powers of a ratio of at most 1.
constexpr std::array<std::int64_t, 6> kArcTangent{32767, -10899, 6342, -3815, 1725, -384};

std::int64_t arc_tangent_of(std::int64_t ratio) {
  const std::int64_t square = round2(ratio * ratio, kRatioBits);
  std::int64_t sum = 0;
  for (std::size_t i = kArcTangent.size(); i > 0; --i) {
    sum = round2(sum * square, kRatioBits) + kArcTangent[i - 1];
  }
  return round2(sum * ratio, 17);
}

std::int64_t absolute(std::int64_t x) { return x < 0 ? -x : x; }

}  // namespace

Vec3l CornerGeometry::triangle_normal(std::uint32_t t) const {
  const Vec3l a = difference(3 * t, 3 * t + 1);
  const Vec3l b = difference(3 * t, 3 * t + 2);
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool CornerGeometry::is_longest_edge(std::uint32_t c) const {
  const std::int64_t length = edge_length(c);
  return length >= edge_length(next_corner(c)) && length >= edge_length(previous_corner(c));
}

bool CornerGeometry::is_likely_diagonal(std::uint32_t c, std::uint32_t mate) const {
  if (!is_longest_edge(c) || !is_longest_edge(mate)) return false;
  Vec3l n = normalize3(triangle_normal(c / 3));
  Vec3l m = normalize3(triangle_normal(mate / 3));
  for (std::size_t k = 0; k < 3; ++k) {
    n[k] = round2(n[k], 16);
    m[k] = round2(m[k], 16);
  }
  // Whether the cosine exceeds 7/8.
  return 8 * dot(n, m) > 7 * (std::int64_t{1} << 28);
}

std::int64_t CornerGeometry::angle_at(std::uint32_t c) const {
  const auto sides = differences<2>(c, {next_corner(c), previous_corner(c)});
  const std::int64_t length = dot(sides[0], sides[0]);
  if (length == 0 || sides[1] == Vec3l{}) return 0;
  const std::int64_t x = dot(sides[0], sides[1]);
  const std::int64_t y = height_above(sides[1], sides[0], length);
  const auto ratio = [](std::int64_t low, std::int64_t high) {
    return div_round(low * (std::int64_t{1} << kRatioBits), std::max<std::int64_t>(high, 1));
  };
  const std::int64_t angle = y <= absolute(x)
                                 ? arc_tangent_of(ratio(y, absolute(x)))
                                 : kRightAngle - arc_tangent_of(ratio(absolute(x), y));
  return x < 0 ? 2 * kRightAngle - angle : angle;
}

std::int64_t place_along(const Vec3l& v, const Vec3l& edge, std::int64_t length) {
  constexpr std::int64_t kMax = std::int64_t{64} << kCornerFractionBits;
  return clip3(-kMax, kMax, div_round(dot(v, edge) * (1 << kCornerFractionBits), length));
}

std::int64_t height_above(const Vec3l& v, const Vec3l& edge, std::int64_t length) {
  const std::int64_t along = dot(v, edge);
  return isqrt(dot(v, v) * length - along * along);
}

}  // namespace rlpc
