#include "encoder/codec/metrics/vertex_normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "encoder/testing/bumpy_sheet.h"

namespace rlpc {
namespace {

std::vector<double> exact(const Frame& frame) { return {frame.begin(), frame.end()}; }

// Turns a frame about x.
Frame turned(const Frame& frame, double degrees) {
  const double c = std::cos(degrees * std::numbers::pi / 180.0);
  const double s = std::sin(degrees * std::numbers::pi / 180.0);
  Frame result = frame;
  for (std::size_t i = 0; i < frame.size(); i += 3) {
    const double y = frame[i + 1];
    const double z = frame[i + 2];
    result[i + 1] = static_cast<float>(c * y - s * z);
    result[i + 2] = static_cast<float>(s * y + c * z);
  }
  return result;
}

TEST(VertexNormals, DeviateByTheAngleOfARotation) {
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
  const Frame flat{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  for (const double degrees : {0.0, 0.01, 3.0, 90.0, 180.0}) {
    const SquaredAngles angles =
        normal_deviation(triangles, exact(flat), turned(flat, degrees));
    EXPECT_NEAR(angles.rms(), degrees, 1e-4);
    EXPECT_NEAR(angles.weight, 1.0, 1e-12);
  }
}

// One triangle of area 2 turns by 30 degrees, one of area 8 stays.
TEST(VertexNormals, AreWeightedByArea) {
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
  const Frame original{0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0};
  Frame decoded = turned(original, 30.0);
  std::copy(original.begin() + 9, original.end(), decoded.begin() + 9);
  const SquaredAngles angles = normal_deviation(triangles, exact(original), decoded);
  EXPECT_NEAR(angles.rms(), 30.0 * std::sqrt(0.2), 1e-4);
  EXPECT_NEAR(angles.weight, 10.0, 1e-12);
}

TEST(VertexNormals, CountAsARightAngleWhereTheyAreLost) {
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
  const Frame original{0, 0, 0, 2, 0, 0, 0, 2, 0, 1, 1, 1, 1, 1, 1, 1, 1, 1};
  Frame decoded = original;
  decoded[7] = 0.0F;
  EXPECT_DOUBLE_EQ(normal_deviation(triangles, exact(original), decoded).rms(), 90.0);
  // The second triangle has no normal to lose.
  EXPECT_EQ(normal_deviation(triangles, exact(decoded), decoded).rms(), 0.0);
  EXPECT_EQ(normal_deviation({}, exact(original), decoded).rms(), 0.0);
}

TEST(VertexNormals, FlickerByTheChangeOfTheError) {
  const std::vector<Triangle> triangles = sheet_triangles(5);
  NormalErrors errors(25, triangles);
  const Frame still = sheet(5, 0.0F, 1);
  const auto flicker = [&](const Frame& decoded) {
    const NormalErrors::OfFrame found = errors.add_frame(still, decoded);
    EXPECT_DOUBLE_EQ(found.deviation.rms(),
                     normal_deviation(triangles, exact(still), decoded).rms());
    return found.flicker;
  };
  EXPECT_EQ(flicker(turned(still, 2.0)).weight, 0.0);
  EXPECT_EQ(flicker(turned(still, 2.0)).rms(), 0.0);
  const double once = flicker(still).rms();
  EXPECT_GT(once, 1.0);
  EXPECT_LE(once, 2.0);
  EXPECT_NEAR(flicker(turned(still, 2.0)).rms(), once, 1e-9);
  // From one side to the other, by twice the chord.
  EXPECT_NEAR(flicker(turned(still, -2.0)).rms(), 2.0 * once, 1e-3);
}

TEST(VertexNormals, DeviateInProportionToNoise) {
  const std::vector<Triangle> triangles = sheet_triangles(20);
  const Frame original = sheet(20, 0.0F, 1);
  std::vector<double> found;
  for (const float size : {0.001F, 0.002F, 0.004F}) {
    std::mt19937 random(7);
    Frame noisy = original;
    for (float& c : noisy) {
      c += size * (static_cast<float>(random()) / 4294967296.0F - 0.5F);
    }
    found.push_back(normal_deviation(triangles, exact(original), noisy).rms());
  }
  EXPECT_GT(found[0], 0.0);
  EXPECT_NEAR(found[1] / found[0], 2.0, 0.02);
  EXPECT_NEAR(found[2] / found[1], 2.0, 0.02);
}

}  // namespace
}  // namespace rlpc
