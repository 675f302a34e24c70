#include "common/codec/attributes/recon/attribute_prediction.h"

#include <gtest/gtest.h>

#include <vector>

namespace rlpc {
namespace {

// Mesh with one value per vertex, coded in the order of the sectors.
class Mesh {
 public:
  Mesh(std::vector<Triangle> triangles, std::vector<std::int32_t> positions)
      : triangles_(std::move(triangles)),
        positions_(std::move(positions)),
        num_vertices_(static_cast<std::uint32_t>(positions_.size() / 3)) {}

  // Returns the prediction of each vertex for given values.
  std::vector<AttributeValue> predictions(const AttributeHeader& header,
                                          const std::vector<AttributeValue>& values) const {
    std::vector<AttributeValue> predictions(num_vertices_);
    AttributePredictor predictor({header, mates_, none_, sectors_, order_, &geometry_});
    for (const std::uint32_t x : order_.order) {
      predictions[x] = predictor.predict(x);
      predictor.learn(x, values[x]);
    }
    return predictions;
  }
  const std::vector<std::uint32_t>& order() const { return order_.order; }

 private:
  std::vector<Triangle> triangles_;
  std::vector<std::int32_t> positions_;
  std::uint32_t num_vertices_;
  Vector<bool> none_;
  Vector<std::uint32_t> mates_ = find_edge_mates(num_vertices_, triangles_);
  Sectors sectors_ = sectors_of_vertices(num_vertices_, triangles_);
  SectorOrder order_{sectors_};
  CornerGeometry geometry_{triangles_, positions_};
};

AttributeHeader integers(std::uint32_t num_components, AttributePrediction prediction) {
  AttributeHeader header;
  header.num_components = num_components;
  header.value_bits = 10;
  header.prediction = prediction;
  return header;
}

Mesh square() { return {{{0, 1, 2}, {0, 2, 3}}, {0, 0, 0, 100, 0, 0, 100, 100, 0, 0, 100, 0}}; }

TEST(AttributePredictor, BeginsInTheMiddleThenRepeatsTheNeighbour) {
  const AttributeHeader header = integers(1, AttributePrediction::kMean);
  ASSERT_EQ(square().order(), (std::vector<std::uint32_t>{0, 1, 2, 3}));
  const auto predictions = square().predictions(header, {{7}, {9}, {0}, {0}});
  EXPECT_EQ(predictions[0][0], 512);
  EXPECT_EQ(predictions[1][0], 7);
}

TEST(AttributePredictor, MeanOrParallelogram) {
  const std::vector<AttributeValue> values{{100, 3}, {200, 0}, {220, 8}, {0, 0}};
  auto predictions = square().predictions(integers(2, AttributePrediction::kMean), values);
  EXPECT_EQ(predictions[2], (AttributeValue{150, 2}));
  EXPECT_EQ(predictions[3], (AttributeValue{160, 6}));
  predictions = square().predictions(integers(2, AttributePrediction::kParallelogram), values);
  EXPECT_EQ(predictions[2], (AttributeValue{150, 2}));  // no known value across its edge
  EXPECT_EQ(predictions[3], (AttributeValue{120, 11}));
}

TEST(AttributePredictor, PredictionsStayInRange) {
  const auto predictions = square().predictions(
      integers(2, AttributePrediction::kParallelogram), {{1000, 0}, {0, 900}, {1000, 0}, {}});
  EXPECT_EQ(predictions[3], (AttributeValue{1023, 0}));
}

TEST(AttributePredictor, TextureCoordinatesHaveTheShapeOfTheirTriangles) {
  const AttributeHeader header = integers(2, AttributePrediction::kPositions);
  // Half as large, turned by a quarter, moved.
  auto predictions = square().predictions(header, {{300, 40}, {300, 90}, {250, 90}, {}});
  EXPECT_EQ(predictions[2], (AttributeValue{250, 90}));
  EXPECT_EQ(predictions[3], (AttributeValue{250, 40}));
  // Mirrored: the third vertex is predicted on the wrong side; from its value, the fourth is
  // predicted on the right one.
  predictions = square().predictions(header, {{300, 40}, {300, 90}, {350, 90}, {}});
  EXPECT_EQ(predictions[2], (AttributeValue{250, 90}));
  EXPECT_EQ(predictions[3], (AttributeValue{350, 40}));
}

TEST(AttributePredictor, EdgesWithoutLengthPredictTheirMiddle) {
  const Mesh mesh({{0, 1, 2}}, {5, 5, 5, 5, 5, 5, 9, 5, 5});
  const auto predictions =
      mesh.predictions(integers(2, AttributePrediction::kPositions), {{10, 30}, {20, 50}, {}});
  EXPECT_EQ(predictions[2], (AttributeValue{15, 40}));
}

// A strip whose rungs are alternately long and short, so that parallelograms mislead, with
// texture coordinates that are its positions.
TEST(AttributePredictor, LearnsWhichPredictionHolds) {
  constexpr std::uint32_t kRungs = 60;
  std::vector<Triangle> triangles;
  std::vector<std::int32_t> positions;
  std::vector<AttributeValue> values;
  for (std::uint32_t i = 0; i < kRungs; ++i) {
    const auto x = static_cast<std::int32_t>(10 * i);
    const std::int32_t height = i % 2 == 0 ? 20 : 60;
    positions.insert(positions.end(), {x, 0, 0, x, height, 0});
    values.insert(values.end(), {{x, 0}, {x, height}});
    if (i == 0) continue;
    const std::uint32_t v = 2 * i;
    triangles.insert(triangles.end(), {{v - 2, v, v - 1}, {v - 1, v, v + 1}});
  }
  const Mesh mesh(triangles, positions);
  const auto predictions =
      mesh.predictions(integers(2, AttributePrediction::kPositions), values);
  const auto error_at = [&](std::uint32_t v) {
    const std::int64_t e = predictions[v][1] - values[v][1];
    return e < 0 ? -e : e;
  };
  EXPECT_GT(error_at(3), 5);
  EXPECT_LE(error_at(2 * kRungs - 1), 1);
}

TEST(AttributePredictor, IntegersAreClippedAndFloatsWrap) {
  const Mesh mesh = square();
  AttributeHeader header = integers(2, AttributePrediction::kMean);
  const std::vector<std::uint32_t> residual{5, static_cast<std::uint32_t>(-5)};
  const std::vector<std::uint32_t> mates;
  const Vector<bool> none;
  const Sectors sectors = sectors_of_vertices(0, {});
  const SectorOrder order(sectors);
  const AttributePredictor integer_predictor({header, mates, none, sectors, order});
  EXPECT_EQ(integer_predictor.value_of({1020, 3}, residual), (AttributeValue{1023, 0}));
  header.kind = ValueKind::kFloats;
  header.value_bits = 32;
  const AttributePredictor float_predictor({header, mates, none, sectors, order});
  EXPECT_EQ(float_predictor.value_of({0xFFFFFFFE, 3}, residual),
            (AttributeValue{3, 0xFFFFFFFE}));
}

}  // namespace
}  // namespace rlpc
