#include "common/codec/kinds/cluster/recon/lcf.h"

namespace rlpc {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << kAxisFractionBits;

Vec3l cross(const Vec3l& a, const Vec3l& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

bool is_zero(const Vec3l& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

// 8.4.2 Degenerate seed triangles: a direction perpendicular to x, for collinear seeds.
Vec3l direction_across(const Vec3l& x) {
  std::size_t smallest = 0;
  const auto magnitude = [&](std::size_t c) { return x[c] < 0 ? -x[c] : x[c]; };
  for (std::size_t c = 1; c < 3; ++c) {
    if (magnitude(c) < magnitude(smallest)) smallest = c;
  }
  Vec3l unit{0, 0, 0};
  unit[smallest] = 1;
  return cross(x, unit);
}

}  // namespace

// 8.4.1 Frame of a seed triangle
Lcf make_lcf(const Vec3i& p1, const Vec3i& p2, const Vec3i& p3) {
  Vec3l edge{};
  Vec3l side{};
  Lcf lcf{};
  for (std::size_t c = 0; c < 3; ++c) {
    edge[c] = std::int64_t{p2[c]} - p1[c];
    side[c] = std::int64_t{p3[c]} - p1[c];
    lcf.doubled_origin[c] = std::int64_t{p1[c]} + p2[c];
  }
  if (is_zero(edge)) {
    lcf.axis = {Vec3l{kOne, 0, 0}, Vec3l{0, kOne, 0}, Vec3l{0, 0, kOne}};
    return lcf;
  }
  const Vec3l x = normalize3(edge);
  Vec3l normal = cross(edge, side);  // |edge|, |side| <= 2^24: exact, at most 2^49
  if (is_zero(normal)) normal = direction_across(x);
  const Vec3l z = normalize3(normal);
  Vec3l y = cross(z, x);  // below 2^61
  for (std::int64_t& c : y) c = round2(c, kAxisFractionBits);
  lcf.axis = {x, y, z};
  return lcf;
}

}  // namespace rlpc
