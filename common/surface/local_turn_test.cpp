#include "common/surface/local_turn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace rlpc {
namespace {

using Vec3 = LocalTurn::Vec3;

constexpr double kHalfTurn = std::numbers::pi;

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Rotation about an axis of length 1 (Rodrigues).
struct Rotation {
  Vec3 axis;
  double angle;

  Vec3 operator()(const Vec3& v) const {
    const Vec3 across = cross(axis, v);
    const double along = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
    Vec3 turned{};
    for (std::size_t c = 0; c < 3; ++c) {
      turned[c] = std::cos(angle) * v[c] + std::sin(angle) * across[c] +
                  (1 - std::cos(angle)) * along * axis[c];
    }
    return turned;
  }
};

constexpr Vec3 kAxis{0.48, 0.6, 0.64};

// Edges around a vertex, each of which forms a triangle with the next.
const std::vector<Vec3> kRing{{2, 0, 0.3}, {0.5, 1.5, 0}, {-1, 1, 0.2}, {-1, -2, 0.1}};

// Returns the turn of a ring whose edges change.
LocalTurn turn_of(const std::vector<Vec3>& before, const std::vector<Vec3>& after) {
  LocalTurn turn;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const std::size_t j = (i + 1) % before.size();
    turn.add_edge(before[i], after[i]);
    turn.add_area(cross(before[i], before[j]), cross(after[i], after[j]));
  }
  turn.find();
  return turn;
}

std::vector<Vec3> moved(const std::vector<Vec3>& ring, const Rotation& rotation, double scale) {
  std::vector<Vec3> all;
  for (const Vec3& edge : ring) {
    all.push_back(rotation(edge));
    for (double& x : all.back()) x *= scale;
  }
  return all;
}

void expect_near(const Vec3& found, const Vec3& wanted, double tolerance) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], tolerance) << c;
}

TEST(LocalTurn, FindsRotationsOfAnyAngleAndScale) {
  const Vec3 normal{0.1, -0.2, 0.9};
  for (const double angle : {0.0, 1e-6, 0.5, 2.0, kHalfTurn - 1e-6, kHalfTurn, 4.0}) {
    for (const double scale : {1e-12, 1.0, 3.0, 1e12}) {
      const Rotation rotation{kAxis, angle};
      const LocalTurn turn = turn_of(kRing, moved(kRing, rotation, scale));
      expect_near(turn.turned(normal), rotation(normal), 1e-6);
    }
  }
}

TEST(LocalTurn, OfOneTriangle) {
  const std::vector<Vec3> ring{{2, 0, 0}, {0.1, 0.4, 0}};
  LocalTurn turn;
  const Rotation rotation{kAxis, 2.5};
  for (const Vec3& edge : ring) turn.add_edge(edge, rotation(edge));
  const Vec3 area = cross(ring[0], ring[1]);
  turn.add_area(area, rotation(area));
  turn.find();
  expect_near(turn.turned(area), rotation(area), 1e-6);
}

TEST(LocalTurn, NoiseTurnsByAsMuchAsItMovesTheEdges) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.01);
  const Rotation rotation{kAxis, 1.3};
  for (int i = 0; i < 100; ++i) {
    std::vector<Vec3> after = moved(kRing, rotation, 1.0);
    for (Vec3& edge : after) {
      for (double& x : edge) x += noise(random);
    }
    const Vec3 up{0.0, 0.0, 1.0};
    expect_near(turn_of(kRing, after).turned(up), rotation(up), 0.04);
  }
}

// The normal of the surface makes half a turn where a small fold opens; the surface does not.
TEST(LocalTurn, FoldsHardlyTurn) {
  std::vector<Vec3> folded = kRing;
  for (Vec3& edge : folded) edge[1] *= 0.01;
  std::vector<Vec3> after = folded;
  for (Vec3& edge : after) edge[1] = -edge[1];
  const Vec3 up{0.0, 0.0, 1.0};
  EXPECT_GT(turn_of(folded, after).turned(up)[2], 0.9);
}

TEST(LocalTurn, StaysWhereNoRotationIsNearest) {
  const Vec3 normal{0.0, 0.6, 0.8};
  LocalTurn nothing;
  nothing.find();
  EXPECT_EQ(nothing.turned(normal), normal);
  LocalTurn point = turn_of({{0, 0, 0}, {0, 0, 0}}, kRing);
  EXPECT_EQ(point.turned(normal), normal);
  const LocalTurn line = turn_of({{1, 0, 0}, {-2, 0, 0}}, {{0, 1, 0}, {0, -2, 0}});
  EXPECT_EQ(line.turned(normal), normal);
}

}  // namespace
}  // namespace rlpc
