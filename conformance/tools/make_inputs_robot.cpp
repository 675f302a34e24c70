// A robot arm that picks up a part and puts it down again: rigid closed components on hinges.
#include <algorithm>
#include <utility>

#include "conformance/tools/make_inputs.h"

namespace rlpc::inputs {

namespace {

struct Part {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::size_t link = 0;  // the link that it moves with
};

enum Link : std::size_t {
  kBase,
  kTurret,
  kUpperArm,
  kForearm,
  kWrist,
  kFingers,
  kPiece = kFingers + 2,
  kFan,
  kLinks
};

Vec3 axis_vector(int axis, double x) {
  return {axis == 0 ? x : 0, axis == 1 ? x : 0, axis == 2 ? x : 0};
}

// Profile (radius, height) pairs, turned about `axis`; closed by a point at both ends.
Part lathe(std::size_t link, Vec3 centre, int axis, std::uint32_t sides,
           const std::vector<std::pair<double, double>>& profile) {
  Part part;
  part.link = link;
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const auto ring = static_cast<std::uint32_t>(profile.size());
  for (const auto& [radius, height] : profile) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const double turns = static_cast<double>(s) / sides;
      part.vertices.push_back(centre + axis_vector(axis, height) +
                              axis_vector(u, radius * cos_turns(turns)) +
                              axis_vector(v, radius * sin_turns(turns)));
    }
  }
  const std::uint32_t bottom = ring * sides;
  part.vertices.push_back(centre + axis_vector(axis, profile.front().second));
  part.vertices.push_back(centre + axis_vector(axis, profile.back().second));
  for (std::uint32_t s = 0; s < sides; ++s) {
    const std::uint32_t t = (s + 1) % sides;
    part.triangles.push_back({bottom, t, s});
    for (std::uint32_t r = 0; r + 1 < ring; ++r) {
      const std::uint32_t a = r * sides;
      const std::uint32_t b = a + sides;
      part.triangles.push_back({a + s, a + t, b + t});
      part.triangles.push_back({a + s, b + t, b + s});
    }
    const std::uint32_t top = (ring - 1) * sides;
    part.triangles.push_back({bottom + 1, top + s, top + t});
  }
  return part;
}

Part cylinder(std::size_t link, Vec3 centre, int axis, std::uint32_t sides, double radius,
              double half_height) {
  return lathe(link, centre, axis, sides, {{radius, -half_height}, {radius, half_height}});
}

// An eight-sided beam along y from `foot`, bevelled at both ends, narrower by `taper` at the
// top.
Part beam(std::size_t link, Vec3 foot, double height, double width, double depth,
          double taper) {
  Part part = lathe(
      link, foot, 1, 8,
      {{0.4, 0}, {0.5, 0.1 * height}, {0.5 * taper, 0.9 * height}, {0.4 * taper, height}});
  for (Vec3& p : part.vertices) {
    p.x = foot.x + width * (p.x - foot.x);
    p.z = foot.z + depth * (p.z - foot.z);
  }
  return part;
}

// A torus about y.
Part ring(std::size_t link, Vec3 centre, double radius, double thickness) {
  constexpr std::uint32_t kAround = 12;
  constexpr std::uint32_t kAcross = 5;
  Part part;
  part.link = link;
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const double a = static_cast<double>(i) / kAround;
      const double b = static_cast<double>(j) / kAcross;
      const double r = radius + thickness * cos_turns(b);
      part.vertices.push_back(
          centre + Vec3{r * cos_turns(a), thickness * sin_turns(b), r * sin_turns(a)});
      const std::uint32_t p = i * kAcross + j;
      const std::uint32_t q = i * kAcross + (j + 1) % kAcross;
      const std::uint32_t p_next = (p + kAcross) % (kAround * kAcross);
      const std::uint32_t q_next = (q + kAcross) % (kAround * kAcross);
      part.triangles.push_back({p, q, q_next});
      part.triangles.push_back({p, q_next, p_next});
    }
  }
  return part;
}

constexpr Vec3 kShoulder{0, 0.62, 0};
constexpr Vec3 kElbow{0, 1.52, 0};
constexpr Vec3 kHand{0, 2.27, 0};
constexpr Vec3 kGrip{0, 2.72, 0};  // between the finger tips
constexpr Vec3 kFanCentre{-0.75, 0.12, 0.6};

// Makes the parts in the rest pose: the arm straight up, the piece at the origin.
std::vector<Part> robot_parts() {
  std::vector<Part> parts;
  parts.push_back(cylinder(kBase, {0, 0.1, 0}, 1, 16, 0.5, 0.1));
  parts.push_back(cylinder(kTurret, {0, 0.33, 0}, 1, 12, 0.32, 0.12));
  parts.push_back(cylinder(kTurret, kShoulder, 2, 10, 0.2, 0.27));
  parts.push_back(beam(kUpperArm, {0, 0.62, 0}, 0.86, 0.3, 0.36, 0.75));
  parts.push_back(cylinder(kUpperArm, kElbow, 2, 10, 0.15, 0.22));
  parts.push_back(beam(kForearm, {0, 1.52, 0}, 0.68, 0.24, 0.28, 0.7));
  parts.push_back(cylinder(kWrist, kHand, 2, 8, 0.11, 0.16));
  parts.push_back(beam(kWrist, {0, 2.34, 0}, 0.1, 0.2, 0.7, 1));
  parts.push_back(beam(kFingers, {0, 2.44, -0.25}, 0.34, 0.14, 0.08, 0.7));
  parts.push_back(beam(kFingers + 1, {0, 2.44, 0.25}, 0.34, 0.14, 0.08, 0.7));
  parts.push_back(ring(kPiece, {0, 0, 0}, 0.14, 0.07));
  parts.push_back(cylinder(kFan, kFanCentre, 1, 8, 0.16, 0.12));
  parts.push_back(beam(kFan, kFanCentre + Vec3{0, 0.12, 0}, 0.05, 0.9, 0.12, 1));
  return parts;
}

// Angles in turns, relative to the rest pose; the hand always points down.
struct Joints {
  double yaw = 0;
  double shoulder = 0;
  double elbow = 0;
  double grip = 0;  // distance that each finger has moved inwards
};

Motion hand_motion(const Joints& j) {
  const Vec3 side{0, 0, -1};
  return rotation({0, 0, 0}, {0, 1, 0}, j.yaw) * rotation(kShoulder, side, j.shoulder) *
         rotation(kElbow, side, j.elbow) * rotation(kHand, side, 0.5 - j.shoulder - j.elbow);
}

constexpr double kPickYaw = 0.02;
constexpr double kPlaceYaw = -0.3;
constexpr Joints kLow{0, 0.167, 0.205, 0};
constexpr Joints kHigh{0, 0.07, 0.22, 0};
constexpr double kClosed = 0.03;
constexpr double kPickTime = 22;   // frames: the fingers have closed
constexpr double kPlaceTime = 56;  // the fingers begin to open

Joints joints_at(double frame) {
  const double low = smooth_step(6, 18, frame) - smooth_step(24, 34, frame) +
                     smooth_step(46, 55, frame) - smooth_step(60, 71, frame);
  Joints j;
  j.yaw = kPickYaw + (0.12 * (1 - smooth_step(0, 12, frame))) +
          (kPlaceYaw - kPickYaw) * smooth_step(28, 50, frame);
  j.shoulder = kHigh.shoulder + low * (kLow.shoulder - kHigh.shoulder);
  j.elbow = kHigh.elbow + low * (kLow.elbow - kHigh.elbow);
  j.grip = kClosed * (smooth_step(18, kPickTime, frame) - smooth_step(kPlaceTime, 60, frame));
  return j;
}

std::array<Motion, kLinks> link_motions(double frame) {
  const Joints j = joints_at(frame);
  const Vec3 side{0, 0, -1};
  std::array<Motion, kLinks> motions;
  motions[kTurret] = rotation({0, 0, 0}, {0, 1, 0}, j.yaw);
  motions[kUpperArm] = motions[kTurret] * rotation(kShoulder, side, j.shoulder);
  motions[kForearm] = motions[kUpperArm] * rotation(kElbow, side, j.elbow);
  motions[kWrist] = hand_motion(j);
  motions[kFingers] = motions[kWrist] * translation({0, 0, j.grip});
  motions[kFingers + 1] = motions[kWrist] * translation({0, 0, -j.grip});
  // The piece stays in the hand while the fingers are closed, otherwise where it was put.
  motions[kPiece] =
      hand_motion(joints_at(std::clamp(frame, kPickTime, kPlaceTime))) * translation(kGrip);
  motions[kFan] = rotation(kFanCentre, {0, 1, 0}, frame / 48 + 0.04 * sin_turns(frame / 75));
  return motions;
}

}  // namespace

MadeAnimation make_robot() {
  constexpr int kFrames = 75;
  const std::vector<Part> parts = robot_parts();
  MadeAnimation animation;
  animation.name = "robot_arm";
  std::uint32_t first = 0;
  for (const Part& part : parts) {
    for (const Triangle& t : part.triangles) {
      animation.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
    first += static_cast<std::uint32_t>(part.vertices.size());
  }
  for (int f = 0; f < kFrames; ++f) {
    const std::array<Motion, kLinks> motions = link_motions(f);
    std::vector<Vec3> frame;
    for (const Part& part : parts) {
      for (const Vec3& p : part.vertices) frame.push_back(motions[part.link](p));
    }
    animation.frames.push_back(std::move(frame));
  }
  return animation;
}

}  // namespace rlpc::inputs
