#include "common/codec/mesh_prediction/rest_prediction.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace rlpc {
namespace {

// Two triangles with the edge (0, 1): 3 is predicted from the hinge 0, 1, 2.
const std::vector<Triangle> kHinge{{0, 1, 2}, {1, 0, 3}};

struct Shape {
  Topology topology = make_topology(4, kHinge);
  RestOrder order{topology, kHinge};
};

Vec3l predicted(const std::vector<std::int32_t>& values, int edge, int ring) {
  const Shape shape;
  return RestPrediction(shape.order, values, 20).predict(3, {edge, ring});
}

TEST(RestPrediction, OfOneHingeIsAlongIt) {
  const std::vector<std::int32_t> values{0, 0, 0, 20, 10, 0, 6, -30, 8, 0, 0, 0};
  // Middle of the edge: 10, 5, 0; from 2 to there: 4, 35, -8.
  EXPECT_EQ(predicted(values, 16, 0), (Vec3l{14, 40, -8}));
  EXPECT_EQ(predicted(values, 0, 0), (Vec3l{10, 5, 0}));
  EXPECT_EQ(predicted(values, 8, 0), (Vec3l{12, 23, -4}));  // 22.5, rounded up
  // The ring of one hinge is its edge, so that its weight does not matter.
  EXPECT_EQ(predicted(values, 16, 63), (Vec3l{14, 40, -8}));
}

TEST(RestPrediction, WithoutHingesIsTheMeanOfTheRing) {
  const std::vector<std::int32_t> values{1, 2, 3, 4, 5, 9, 0, 0, 0, 0, 0, 0};
  const Shape shape;
  const RestPrediction prediction(shape.order, values, 20);
  EXPECT_EQ(prediction.predict(0, {16, 0}), (Vec3l{0, 0, 0}));
  EXPECT_EQ(prediction.predict(1, {16, 0}), (Vec3l{1, 2, 3}));
  EXPECT_EQ(prediction.predict(2, {16, 0}), (Vec3l{3, 4, 6}));  // 2.5 and 3.5, rounded up
}

double product(const Vec3l& x, const Vec3l& y) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    sum +=
        std::ldexp(static_cast<double>(x[c]), -30) * std::ldexp(static_cast<double>(y[c]), -30);
  }
  return sum;
}

// 8.18.5: orthonormal, and within the width of the text, for shapes of all sizes.
TEST(RestPrediction, AxesAreOrthonormal) {
  const Shape shape;
  std::mt19937 random(7);
  for (int bits = 0; bits <= 29; ++bits) {
    for (int i = 0; i < 100; ++i) {
      std::vector<std::int32_t> values(12);
      for (std::int32_t& x : values) {
        x = static_cast<std::int32_t>(static_cast<std::int64_t>(random() >> (32 - 29)) -
                                      (1 << 28)) >>
            (29 - bits);
      }
      const RestPrediction prediction(shape.order, values, 29);
      const RestAxes axes = prediction.axes(shape.order.hinges(3));
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t m = 0; m < 3; ++m) {
          EXPECT_NEAR(product(axes[k], axes[m]), k == m ? 1.0 : 0.0, 1e-7);
        }
        for (const std::int64_t x : axes[k]) EXPECT_LE(std::abs(x), (1 << 30) + 32);
      }
    }
  }
}

TEST(RestPrediction, AxesOfFlatHingesAreThoseOfTheWorld) {
  const Shape shape;
  const std::vector<std::vector<std::int32_t>> flat{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                                                    {0, 0, 0, 2, 2, 2, 4, 4, 4, 0, 0, 0}};
  for (const auto& values : flat) {
    const RestPrediction prediction(shape.order, values, 20);
    EXPECT_EQ(prediction.axes(shape.order.hinges(3)), RestPrediction::world());
  }
  EXPECT_EQ(RestPrediction(shape.order, flat[0], 20).axes({}), RestPrediction::world());
}

// A shape, and below it a copy: moved, turned by a quarter, and optionally mirrored.
TEST(RestPrediction, ACounterpartIsTurnedAndMirrored) {
  const std::vector<Triangle> triangles{{0, 1, 2}, {1, 0, 3}, {4, 5, 6}, {5, 4, 7}};
  const Topology topology = make_topology(8, triangles);
  const RestOrder order(topology, triangles);
  const std::vector<std::array<std::int32_t, 3>> shape{
      {0, 0, 0}, {400, 96, 16}, {160, -320, 64}, {208, 352, 160}};
  for (const bool mirrored : {false, true}) {
    std::vector<std::int32_t> values;
    for (const auto& x : shape) values.insert(values.end(), x.begin(), x.end());
    for (const std::size_t from : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
      const std::size_t v = mirrored && from < 2 ? 1 - from : from;
      const auto& x = shape[v];
      values.insert(values.end(), {1000 - x[1], x[0] - 77, mirrored ? 500 - x[2] : 500 + x[2]});
    }
    values.insert(values.end(), {0, 0, 0});
    const auto& x = shape[3];
    const Vec3l expected{1000 - x[1], x[0] - 77, mirrored ? 500 - x[2] : 500 + x[2]};
    const RestPrediction prediction(order, values, 20);
    const auto own = order.hinges(7);
    const auto other = order.hinges(3);
    const Vec3l found =
        prediction.from_counterpart(own, prediction.axes(own), other, 3, mirrored);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_LE(std::abs(found[c] - expected[c]), 2) << c;
  }
}

}  // namespace
}  // namespace rlpc
