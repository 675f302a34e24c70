#include "encoder/meshes/gltf/track.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "encoder/codec/math/det_math.h"

namespace rlpc {

namespace {

// A time relative to the keys of a track: `part` of the way from `key` to the next.
struct KeyPlace {
  std::size_t key = 0;
  double part = 0.0;      // 0 where the value is held
  double duration = 0.0;  // seconds from `key` to the next
};

KeyPlace find_place(const GltfTrack& track, double time) {
  assert(!track.times.empty());
  const auto next = std::upper_bound(track.times.begin(), track.times.end(), time);
  if (next == track.times.begin()) return {};
  const auto key = static_cast<std::size_t>(next - track.times.begin()) - 1;
  if (next == track.times.end()) return {key, 0.0, 0.0};
  const double first = track.times[key];
  const double duration = *next - first;
  return {key, (time - first) / duration, duration};
}

double length_of(const GltfQuaternion& q) {
  return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

// Interpolates on the sphere (glTF 2.0, appendix C.4).
GltfQuaternion slerp(const GltfQuaternion& a, GltfQuaternion b, double part) {
  double dot = 0.0;
  for (std::size_t i = 0; i < 4; ++i) dot += a[i] * b[i];
  if (dot < 0) {
    for (double& x : b) x = -x;
  }
  GltfQuaternion sum{};
  GltfQuaternion difference{};
  for (std::size_t i = 0; i < 4; ++i) {
    sum[i] = a[i] + b[i];
    difference[i] = b[i] - a[i];
  }
  // Exact for small angles too, unlike an arc cosine of the dot product.
  const double angle = 2.0 * det_atan(std::min(length_of(difference) / length_of(sum), 1.0));
  const double sine = det_sin(angle);
  const double weight_a = sine > 0 ? det_sin((1.0 - part) * angle) / sine : 1.0 - part;
  const double weight_b = sine > 0 ? det_sin(part * angle) / sine : part;
  GltfQuaternion result{};
  for (std::size_t i = 0; i < 4; ++i) result[i] = weight_a * a[i] + weight_b * b[i];
  return unit_quaternion(result);
}

// Returns the value of a key, without its tangents.
const float* value_at(const GltfTrack& track, std::size_t key) {
  if (track.interpolation != GltfInterpolation::kCubicSpline) {
    return &track.values[key * track.width];
  }
  return &track.values[(3 * key + 1) * track.width];
}

GltfQuaternion rotation_at(const GltfTrack& track, std::size_t key) {
  const float* const value = value_at(track, key);
  return unit_quaternion({value[0], value[1], value[2], value[3]});
}

}  // namespace

GltfQuaternion unit_quaternion(const GltfQuaternion& q) {
  const double length = length_of(q);
  if (!(length > 0)) return {0, 0, 0, 1};
  return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

void sample(const GltfTrack& track, double time, std::span<double> out) {
  assert(out.size() == track.width);
  const auto [key, part, duration] = find_place(track, time);
  const float* const from = value_at(track, key);
  if (part == 0.0 || track.interpolation == GltfInterpolation::kStep) {
    std::copy_n(from, track.width, out.begin());
    return;
  }
  const float* const to = value_at(track, key + 1);
  if (track.interpolation == GltfInterpolation::kLinear) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = from[i] + part * (to[i] - from[i]);
    return;
  }
  // Appendix C.5 of glTF 2.0.
  const float* const out_tangent = from + track.width;
  const float* const in_tangent = to - track.width;
  const double t = part;
  const double t2 = t * t;
  const double t3 = t2 * t;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = (2 * t3 - 3 * t2 + 1) * from[i] + duration * (t3 - 2 * t2 + t) * out_tangent[i] +
             (3 * t2 - 2 * t3) * to[i] + duration * (t3 - t2) * in_tangent[i];
  }
}

GltfQuaternion sample_rotation(const GltfTrack& track, double time) {
  const KeyPlace place = find_place(track, time);
  if (track.interpolation == GltfInterpolation::kLinear && place.part > 0.0) {
    return slerp(rotation_at(track, place.key), rotation_at(track, place.key + 1), place.part);
  }
  GltfQuaternion rotation{};
  sample(track, time, rotation);
  return unit_quaternion(rotation);
}

}  // namespace rlpc
