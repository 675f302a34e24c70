// A sheet held at two corners that falls on a ball in gusty wind: springs as constraints.
#include <algorithm>
#include <utility>

#include "conformance/tools/make_inputs.h"

namespace rlpc::inputs {

namespace {

constexpr std::uint32_t kSide = 20;  // vertices along each edge
constexpr double kSpacing = 0.1;
constexpr int kFrames = 82;
constexpr int kStepsPerFrame = 10;
constexpr int kRelaxations = 12;
constexpr double kTimeStep = 1.0 / (30 * kStepsPerFrame);
constexpr Vec3 kBall{0.1, -0.75, 0.62};
constexpr double kBallRadius = 0.5;

struct Spring {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  double rest = 0;
  double stiffness = 1;
};

class Cloth {
 public:
  Cloth() {
    for (std::uint32_t row = 0; row < kSide; ++row) {
      for (std::uint32_t column = 0; column < kSide; ++column) {
        // The sheet is level at first, and slightly uneven, so that it does not stay symmetric.
        const double ripple = 0.01 * sin_turns(0.13 * column + 0.07 * row);
        position_.push_back({kSpacing * (column - 0.5 * (kSide - 1)), ripple, kSpacing * row});
      }
    }
    previous_ = position_;
    for (std::uint32_t row = 0; row < kSide; ++row) {
      for (std::uint32_t column = 0; column < kSide; ++column) {
        add_spring(row, column, 0, 1, 1);
        add_spring(row, column, 1, 0, 1);
        add_spring(row, column, 1, 1, 0.6);
        add_spring(row, column, 1, -1, 0.6);
        add_spring(row, column, 0, 2, 0.15);
        add_spring(row, column, 2, 0, 0.15);
      }
    }
  }

  static std::vector<Triangle> triangles() {
    std::vector<Triangle> result;
    for (std::uint32_t row = 0; row + 1 < kSide; ++row) {
      for (std::uint32_t column = 0; column + 1 < kSide; ++column) {
        const std::uint32_t v = row * kSide + column;
        if ((row + column) % 2 == 0) {
          result.push_back({v, v + kSide, v + 1});
          result.push_back({v + 1, v + kSide, v + kSide + 1});
        } else {
          result.push_back({v, v + kSide, v + kSide + 1});
          result.push_back({v, v + kSide + 1, v + 1});
        }
      }
    }
    return result;
  }

  const std::vector<Vec3>& positions() const { return position_; }

  void step(double time) {
    const std::vector<Vec3> force = wind_force(time);
    for (std::size_t v = 0; v < position_.size(); ++v) {
      if (is_pinned(v)) continue;
      const Vec3 velocity = position_[v] - previous_[v];
      const Vec3 acceleration = Vec3{0, -9.81, 0} + force[v];
      previous_[v] = position_[v];
      position_[v] = position_[v] + 0.9985 * velocity + kTimeStep * kTimeStep * acceleration;
    }
    for (int n = 0; n < kRelaxations; ++n) {
      for (const Spring& spring : springs_) relax(spring);
      for (std::size_t v = 0; v < position_.size(); ++v) keep_outside_ball(v);
    }
  }

 private:
  static bool is_pinned(std::size_t v) { return v == 0 || v == kSide - 1; }

  void add_spring(std::uint32_t row, std::uint32_t column, std::uint32_t down, int right,
                  double stiffness) {
    const int other = static_cast<int>(column) + right;
    if (row + down >= kSide || other < 0 || other >= static_cast<int>(kSide)) return;
    const std::uint32_t a = row * kSide + column;
    const std::uint32_t b = (row + down) * kSide + static_cast<std::uint32_t>(other);
    const double rest = kSpacing * std::sqrt(static_cast<double>(down * down) + right * right);
    springs_.push_back({a, b, rest, stiffness});
  }

  // Returns the acceleration by the wind that blows through each triangle.
  std::vector<Vec3> wind_force(double time) const {
    std::vector<Vec3> force(position_.size());
    const double gust = 1 + 0.8 * sin_turns(0.55 * time) + 0.5 * sin_turns(1.27 * time + 0.3);
    const Vec3 wind{2.5 * sin_turns(0.4 * time + 0.1), 1.5,
                    6 * sin_turns(0.7 * time + 0.4) * gust};
    for (const Triangle& t : triangles_) {
      const Vec3 normal =
          cross(position_[t[1]] - position_[t[0]], position_[t[2]] - position_[t[0]]);
      const double area2 = length(normal);
      if (area2 == 0) continue;
      const Vec3 velocity = (1 / (3 * kTimeStep)) * ((position_[t[0]] - previous_[t[0]]) +
                                                     (position_[t[1]] - previous_[t[1]]) +
                                                     (position_[t[2]] - previous_[t[2]]));
      const double flutter = 1 + 0.35 * sin_turns(0.9 * position_[t[0]].x - 1.7 * time);
      const double push = dot(normal, flutter * wind - velocity) / area2;
      const Vec3 share = (0.9 * push / area2 * (area2 / (kSpacing * kSpacing))) * normal;
      for (const std::uint32_t v : t) force[v] = force[v] + share;
    }
    return force;
  }

  void relax(const Spring& spring) {
    const Vec3 d = position_[spring.b] - position_[spring.a];
    const double now = length(d);
    const double wa = is_pinned(spring.a) ? 0 : 1;
    const double wb = is_pinned(spring.b) ? 0 : 1;
    if (now == 0 || wa + wb == 0) return;
    const Vec3 move = (spring.stiffness * (now - spring.rest) / (now * (wa + wb))) * d;
    position_[spring.a] = position_[spring.a] + wa * move;
    position_[spring.b] = position_[spring.b] - wb * move;
  }

  void keep_outside_ball(std::size_t v) {
    const Vec3 d = position_[v] - kBall;
    const double distance = length(d);
    if (distance >= kBallRadius || distance == 0 || is_pinned(v)) return;
    position_[v] = kBall + (kBallRadius / distance) * d;
    previous_[v] = previous_[v] + 0.3 * (position_[v] - previous_[v]);  // friction
  }

  std::vector<Vec3> position_;
  std::vector<Vec3> previous_;
  std::vector<Spring> springs_;
  std::vector<Triangle> triangles_ = triangles();
};

}  // namespace

MadeAnimation make_curtain() {
  Cloth cloth;
  MadeAnimation animation;
  animation.name = "curtain";
  animation.triangles = Cloth::triangles();
  for (int f = 0; f < kFrames; ++f) {
    animation.frames.push_back(cloth.positions());
    for (int s = 0; s < kStepsPerFrame; ++s) cloth.step((f * kStepsPerFrame + s) * kTimeStep);
  }
  return animation;
}

}  // namespace rlpc::inputs
