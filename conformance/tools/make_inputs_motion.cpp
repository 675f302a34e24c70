#include <cmath>

#include "conformance/tools/make_inputs.h"

namespace rlpc::inputs {

double sin_turns(double turns) {
  constexpr double kTwoPi = 6.283185307179586;
  double t = turns - std::floor(turns);
  const double sign = t < 0.5 ? 1 : -1;
  if (t >= 0.5) t -= 0.5;
  if (t > 0.25) t = 0.5 - t;
  const double x = kTwoPi * t;  // 0 to pi / 2
  double sum = 0;
  for (int n = 19; n >= 1; n -= 2) sum = 1 - x * x / ((n + 1) * (n + 2)) * sum;
  return sign * x * sum;
}

double smooth_step(double from, double to, double x) {
  const double t = x <= from ? 0 : x >= to ? 1 : (x - from) / (to - from);
  return t * t * (3 - 2 * t);
}

Motion translation(Vec3 offset) {
  Motion m;
  m.offset = offset;
  return m;
}

Motion rotation(Vec3 centre, Vec3 axis, double turns) {
  const double s = sin_turns(turns);
  const double c = cos_turns(turns);
  const double d = 1 - c;
  const auto [x, y, z] = axis;
  Motion m;
  m.rows = {Vec3{c + d * x * x, d * x * y - s * z, d * x * z + s * y},
            Vec3{d * x * y + s * z, c + d * y * y, d * y * z - s * x},
            Vec3{d * x * z - s * y, d * y * z + s * x, c + d * z * z}};
  m.offset = centre - m(centre);
  return m;
}

Motion operator*(const Motion& second, const Motion& first) {
  Motion m;
  const Vec3 origin = second(first.offset);
  const auto column = [&](Vec3 unit) { return second(first(unit)) - origin; };
  const Vec3 x = column({1, 0, 0});
  const Vec3 y = column({0, 1, 0});
  const Vec3 z = column({0, 0, 1});
  m.rows = {Vec3{x.x, y.x, z.x}, Vec3{x.y, y.y, z.y}, Vec3{x.z, y.z, z.z}};
  m.offset = origin;
  return m;
}

}  // namespace rlpc::inputs
