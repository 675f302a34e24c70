#include "encoder/codec/kinds/cluster/local_motion.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace rlpc {
namespace {

using Point = std::array<double, 3>;

Vec3i random_position(std::mt19937& random) {
  Vec3i p{};
  for (std::int32_t& c : p) c = static_cast<std::int32_t>(random() % 200001) - 100000;
  return p;
}

TEST(LocalFrame, InvertsTheDecodersTransform) {
  constexpr unsigned kSeed = 1;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (int i = 0; i < 2000; ++i) {
    const Vec3i p1 = random_position(random);
    const Lcf lcf = make_lcf(p1, i % 50 == 0 ? p1 : random_position(random),
                             i % 20 == 0 ? p1 : random_position(random));
    const Vec3i point = random_position(random);
    const Point xyz{static_cast<double>(point[0]), static_cast<double>(point[1]),
                    static_cast<double>(point[2])};
    const Point local = LocalFrame(lcf).to_local(xyz.data());
    // Rounding local coordinates to 1/16 steps moves a point by less than half a step, so it
    // rounds back to the same grid position.
    const Vec3l back = lcf_to_world(lcf, std::llround(16 * local[0]),
                                    std::llround(16 * local[1]), std::llround(16 * local[2]));
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(back[c], point[c]);
  }
}

TEST(LocalFrame, IsInvariantUnderRigidMotion) {
  // Rotated by 90 degrees about z and translated, which is exact on the grid.
  const auto moved = [](const Vec3i& p) { return Vec3i{-p[1] + 77, p[0] - 12, p[2] + 5}; };
  const Vec3i a{0, 0, 0};
  const Vec3i b{90, 40, -20};
  const Vec3i c{10, 80, 33};
  const Vec3i q{-31, 52, 99};
  const Vec3i r = moved(q);
  const Point before{-31, 52, 99};
  const Point after{static_cast<double>(r[0]), static_cast<double>(r[1]),
                    static_cast<double>(r[2])};
  const Point local = LocalFrame(make_lcf(a, b, c)).to_local(before.data());
  const LocalFrame turned(make_lcf(moved(a), moved(b), moved(c)));
  const Point again = turned.to_local(after.data());
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(local[k], again[k], 1e-6);
}

void expect_sums(DistanceSum sum) {
  std::mt19937 random(3);
  constexpr std::size_t kVertices = 37;  // several full SIMD vectors and a remainder
  std::vector<double> motion(kVertices);
  std::vector<double> before(3 * kVertices);
  std::vector<double> expected(kVertices);
  std::vector<Point> last(kVertices);
  for (int f = 0; f < 3; ++f) {
    const LocalFrame frame(
        make_lcf(random_position(random), random_position(random), random_position(random)));
    std::vector<double> xyz(3 * kVertices);
    for (double& x : xyz) x = 0.25 * random_position(random)[0];
    add_local_motion(sum, frame, kVertices, xyz.data(), before.data(), motion.data());
    for (std::size_t v = 0; v < kVertices; ++v) {
      const Point q = frame.to_local(&xyz[3 * v]);
      double squared = 0.0;
      for (std::size_t c = 0; c < 3; ++c) squared += (q[c] - last[v][c]) * (q[c] - last[v][c]);
      expected[v] += sum == DistanceSum::kSquared ? squared : std::sqrt(squared);
      last[v] = q;
    }
  }
  for (std::size_t v = 0; v < kVertices; ++v) {
    EXPECT_DOUBLE_EQ(motion[v], expected[v]) << v;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(before[3 * v + c], last[v][c]);
  }
}

TEST(AddLocalMotion, SumsDistancesAndKeepsTheLastPositions) {
  expect_sums(DistanceSum::kSquared);
  expect_sums(DistanceSum::kPlain);
}

}  // namespace
}  // namespace rlpc
