// Animations of our own making, as input for examples and tests.
//
// They need only additions, multiplications, divisions and square roots, in a fixed order:
// every machine makes the same files.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc::inputs {

struct Vec3 {
  double x = 0;
  double y = 0;
  double z = 0;
};
inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }

// Sine and cosine of an angle in turns, the same on every machine.
double sin_turns(double turns);
inline double cos_turns(double turns) { return sin_turns(turns + 0.25); }

// 0 below `from`, 1 above `to`, smooth between.
double smooth_step(double from, double to, double x);

// A rotation followed by a translation.
struct Motion {
  std::array<Vec3, 3> rows{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  Vec3 offset;
  Vec3 operator()(Vec3 p) const {
    return Vec3{dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)} + offset;
  }
};
Motion translation(Vec3 offset);
// A rotation about the unit vector `axis` through `centre`.
Motion rotation(Vec3 centre, Vec3 axis, double turns);
Motion operator*(const Motion& second, const Motion& first);

struct MadeAnimation {
  std::string name;
  std::vector<Triangle> triangles;
  std::vector<std::vector<Vec3>> frames;  // 30 per second
};

MadeAnimation make_elephant();  // skinned: one closed surface
MadeAnimation make_curtain();   // simulated cloth: one boundary
MadeAnimation make_robot();     // rigid parts: closed components, one of them a ring

}  // namespace rlpc::inputs
