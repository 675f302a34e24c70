#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "encoder/meshes/gltf/track.h"

namespace rlpc {
namespace {

using Interpolation = GltfInterpolation;

double sample_one(const GltfTrack& track, double time) {
  double value = 0;
  sample(track, time, {&value, 1});
  return value;
}

// Returns a rotation by `degrees` about z, as a quaternion of any length.
std::vector<float> turn(double degrees, double length = 1.0) {
  const double half = degrees / 2 * 3.14159265358979323846 / 180;
  return {0, 0, static_cast<float>(std::sin(half) * length),
          static_cast<float>(std::cos(half) * length)};
}

GltfTrack turns(const std::vector<std::vector<float>>& quaternions, Interpolation how) {
  GltfTrack track{how, 4, {}, {}};
  for (std::size_t i = 0; i < quaternions.size(); ++i) {
    track.times.push_back(static_cast<float>(i));
    track.values.insert(track.values.end(), quaternions[i].begin(), quaternions[i].end());
  }
  return track;
}

// Returns the angle about z in degrees; q and -q are the same rotation.
double degrees_of(const GltfQuaternion& q) {
  EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 1e-12);
  return 2 * std::atan2(q[2], q[3]) * 180 / 3.14159265358979323846;
}

TEST(GltfTrack, StepsHoldEachValueUntilTheNext) {
  const GltfTrack track{Interpolation::kStep, 1, {1, 2, 4}, {10, 20, 30}};
  EXPECT_EQ(sample_one(track, 0), 10);
  EXPECT_EQ(sample_one(track, 1), 10);
  EXPECT_EQ(sample_one(track, 1.999), 10);
  EXPECT_EQ(sample_one(track, 2), 20);
  EXPECT_EQ(sample_one(track, 3.999), 20);
  EXPECT_EQ(sample_one(track, 4), 30);
  EXPECT_EQ(sample_one(track, 9), 30);
}

TEST(GltfTrack, LinearTracksAreStraightAndHeldAtTheirEnds) {
  const GltfTrack track{Interpolation::kLinear, 2, {1, 2, 4}, {10, 0, 20, 1, 40, -1}};
  std::vector<double> value(2);
  sample(track, 1.25, value);
  EXPECT_EQ(value, (std::vector<double>{12.5, 0.25}));
  sample(track, 3.5, value);
  EXPECT_EQ(value, (std::vector<double>{35, -0.5}));
  sample(track, -1, value);
  EXPECT_EQ(value, (std::vector<double>{10, 0}));
  sample(track, 4.5, value);
  EXPECT_EQ(value, (std::vector<double>{40, -1}));
}

TEST(GltfTrack, CubicSplinesFollowTheirTangents) {
  // x^3 - 2x at 0 and 2, with its derivatives 3x^2 - 2: one cubic, met exactly.
  const GltfTrack track{Interpolation::kCubicSpline, 1, {0, 2}, {99, 0, -2, 10, 4, 99}};
  for (const double x : {0.0, 0.25, 1.0, 1.5, 2.0}) {
    EXPECT_NEAR(sample_one(track, x), x * x * x - 2 * x, 1e-12) << x;
  }
  EXPECT_EQ(sample_one(track, -1), 0);
  EXPECT_EQ(sample_one(track, 3), 4);
}

TEST(GltfTrack, OneKeyIsAConstant) {
  for (const Interpolation how : {Interpolation::kStep, Interpolation::kLinear}) {
    EXPECT_EQ(sample_one({how, 1, {3}, {7}}, 0), 7);
    EXPECT_EQ(sample_one({how, 1, {3}, {7}}, 5), 7);
  }
  EXPECT_EQ(sample_one({Interpolation::kCubicSpline, 1, {3}, {1, 7, 2}}, 4), 7);
}

TEST(GltfTrack, RotationsHaveConstantSpeed) {
  const GltfTrack track = turns({turn(10), turn(100)}, Interpolation::kLinear);
  for (const double t : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(degrees_of(sample_rotation(track, t)), 10 + 90 * t, 1e-4) << t;
  }
}

TEST(GltfTrack, RotationsTakeTheShorterArc) {
  std::vector<float> negative = turn(30);
  for (float& x : negative) x = -x;
  const GltfTrack track = turns({turn(-30), negative}, Interpolation::kLinear);
  EXPECT_NEAR(degrees_of(sample_rotation(track, 0.25)), -15, 1e-4);
  const GltfTrack far = turns({turn(-170), turn(170)}, Interpolation::kLinear);
  EXPECT_NEAR(std::abs(degrees_of(sample_rotation(far, 0.5))), 180, 1e-4);
}

TEST(GltfTrack, SmallAndLargeRotationsAreExact) {
  for (const double degrees : {0.0, 1e-30, 1e-3, 89.0, 179.999}) {
    const GltfTrack track = turns({turn(0), turn(degrees)}, Interpolation::kLinear);
    EXPECT_NEAR(degrees_of(sample_rotation(track, 0.75)), 0.75 * degrees, 1e-4) << degrees;
  }
}

TEST(GltfTrack, RotationsAreNormalised) {
  const GltfTrack linear = turns({turn(0, 0.5), turn(90, 3)}, Interpolation::kLinear);
  EXPECT_NEAR(degrees_of(sample_rotation(linear, 1.0 / 3)), 30, 1e-4);
  const GltfTrack step = turns({turn(40, 1e-20), turn(90)}, Interpolation::kStep);
  EXPECT_NEAR(degrees_of(sample_rotation(step, 0.5)), 40, 1e-4);
}

TEST(GltfTrack, CubicRotationsHaveUnitLength) {
  const std::vector<float> flat(4);
  const GltfTrack track{Interpolation::kCubicSpline, 4, {0, 1}, [&] {
                          std::vector<float> values;
                          for (const auto& part : {flat, turn(0), flat, flat, turn(90), flat}) {
                            values.insert(values.end(), part.begin(), part.end());
                          }
                          return values;
                        }()};
  EXPECT_NEAR(degrees_of(sample_rotation(track, 0)), 0, 1e-4);
  EXPECT_NEAR(degrees_of(sample_rotation(track, 0.5)), 45, 1e-4);
  EXPECT_NEAR(degrees_of(sample_rotation(track, 1)), 90, 1e-4);
}

TEST(GltfTrack, SlerpAgreesWithTheLibrary) {
  constexpr unsigned kSeed = 1;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  for (int n = 0; n < 1000; ++n) {
    std::vector<std::vector<float>> q(2, std::vector<float>(4));
    for (auto& one : q) {
      for (float& x : one) x = coordinate(random);
    }
    const GltfQuaternion a = unit_quaternion({q[0][0], q[0][1], q[0][2], q[0][3]});
    GltfQuaternion b = unit_quaternion({q[1][0], q[1][1], q[1][2], q[1][3]});
    double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    for (double& x : b) x = dot < 0 ? -x : x;
    const double angle = std::acos(std::min(std::abs(dot), 1.0));
    if (angle < 0.01) continue;  // an arc cosine is inexact here
    const GltfQuaternion got = sample_rotation(turns(q, Interpolation::kLinear), 0.3);
    for (std::size_t i = 0; i < 4; ++i) {
      const double want =
          (std::sin(0.7 * angle) * a[i] + std::sin(0.3 * angle) * b[i]) / std::sin(angle);
      ASSERT_NEAR(got[i], want, 1e-11);
    }
  }
}

}  // namespace
}  // namespace rlpc
