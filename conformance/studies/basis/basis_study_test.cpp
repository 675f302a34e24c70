#include "conformance/studies/basis/basis_study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "conformance/testing/small_animation.h"

namespace rlpc {
namespace {

using Vectors = std::vector<std::vector<double>>;

// Three axes of 20 values each.
std::vector<double> vector_of(double (*value)(double)) {
  std::vector<double> list;
  for (int c = 0; c < 3; ++c) {
    for (int f = 0; f < 20; ++f) list.push_back(value(f) + c);
  }
  return list;
}

const BasisPredictor& named(const std::vector<BasisPredictor>& list, const std::string& name) {
  for (const BasisPredictor& predictor : list) {
    if (predictor.name == name) return predictor;
  }
  ADD_FAILURE() << name;
  return list[0];
}

TEST(BasisStudy, PredictorsOfOrderNExtrapolatePolynomialsOfDegreeNMinus1) {
  const Vectors polynomials{
      vector_of([](double) { return 5.0; }), vector_of([](double f) { return 3.0 * f; }),
      vector_of([](double f) { return f * f; }), vector_of([](double f) { return f * f * f; })};
  for (std::size_t degree = 0; degree < 4; ++degree) {
    const auto vector = std::span(polynomials).subspan(degree, 1);
    const auto list = basis_predictors(vector);
    for (std::size_t order = 1; order <= 4; ++order) {
      const double missed = missed_squares(vector, named(list, "Cob" + std::to_string(order)));
      EXPECT_EQ(missed < 1e-9, degree < order) << degree << " " << order;
    }
  }
}

TEST(BasisStudy, LpcIsTheLeastSquaresFit) {
  std::vector<double> vector;
  for (int c = 0; c < 3; ++c) {
    double value = c;
    for (int f = 0; f < 30; ++f, value = 0.5 * value + 2.0) vector.push_back(value);
  }
  const auto list = basis_predictors(Vectors{vector});
  const BasisPredictor& lpc = named(list, "LPC1");
  ASSERT_EQ(lpc.weights.size(), 1U);
  EXPECT_NEAR(lpc.weights[0], 0.5, 1e-6);
  EXPECT_NEAR(lpc.offset, 2.0, 1e-6);
  EXPECT_LT(missed_squares(Vectors{vector}, lpc), 1e-12);
}

TEST(BasisStudy, QuantisationLeavesHalfAStepAtMost) {
  const Vectors vectors{vector_of([](double f) { return std::sin(f); }),
                        vector_of([](double f) { return std::cos(0.3 * f); })};
  const std::vector<double> steps{0.1, 0.01};
  for (const BasisPredictor& predictor : basis_predictors(vectors)) {
    const QuantisedBasis coded = quantise(vectors, steps, predictor);
    EXPECT_GT(coded.entropy, 0.0);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LE(coded.error[i], 60.0 * steps[i] * steps[i] / 4.0 + 1e-12) << predictor.name;
      EXPECT_GT(coded.error[i], 0.0) << predictor.name;
    }
  }
}

TEST(BasisStudy, EntropyIsThatOfTheSymbols) {
  std::vector<double> halves(60);  // symbols 0 and 1, each half of the time: one bit
  for (std::size_t j = 0; j < halves.size(); ++j) halves[j] = j % 2 == 0 ? 0.0 : 1.0;
  const std::vector<double> steps{1.0};
  EXPECT_DOUBLE_EQ(quantise(Vectors{halves}, steps, {"direct", {}, 0.0}).entropy, 1.0);
}

class OfAnAnimation : public testing::Test {
 protected:
  void SetUp() override {
    MemoryFrames source = bending_tube(40, 12);
    auto found = analyse_trajectories(source, 20);
    ASSERT_TRUE(found);
    basis_ = *found;
    ASSERT_GE(basis_.vectors.size(), 3U);
  }
  TrajectoryBasis basis_;
};

TEST_F(OfAnAnimation, VectorsAreOrthonormalAndTheirEnergyFalls) {
  for (std::size_t i = 0; i < basis_.vectors.size(); ++i) {
    const auto& a = basis_.vectors[i];
    EXPECT_NEAR(std::inner_product(a.begin(), a.end(), a.begin(), 0.0), 1.0, 1e-9);
    EXPECT_LE(basis_.energy[i], basis_.energy[i == 0 ? 0 : i - 1]);
  }
  const double sum = std::accumulate(basis_.energy.begin(), basis_.energy.end(), 0.0);
  EXPECT_NEAR(sum / basis_.total_energy, 1.0, 1e-3);
}

TEST_F(OfAnAnimation, AMissingBasisIsAnErrorOfAllThatItHolds) {
  const std::vector<double> all(basis_.vectors.size(), 1.0);
  EXPECT_NEAR(kg_error(basis_, all), 100.0, 0.1);
}

TEST_F(OfAnAnimation, StepsFollowTheirRuleAndMeetTheError) {
  const auto predictor = basis_predictors(basis_.vectors).back();
  for (const StepRule rule : kStepRules) {
    const std::vector<double> relative = relative_steps(basis_, rule, 3);
    const std::vector<double> steps = steps_for(basis_, relative, predictor, 0.5);
    const auto vectors = std::span(basis_.vectors).first(3);
    EXPECT_NEAR(kg_error(basis_, quantise(vectors, steps, predictor).error), 0.5, 0.05)
        << name_of(rule);
    const auto& by = rule == StepRule::kCobra ? basis_.sums : basis_.energy;
    const double expected = rule == StepRule::kUniform ? 1.0 : by[0] / by[2];
    EXPECT_NEAR(steps[2] / steps[0], expected, 1e-9 * expected) << name_of(rule);
  }
}

TEST_F(OfAnAnimation, ATripledStepOfTheFirstVectorHurtsMostIfStepsAreEqual) {
  const auto predictor = basis_predictors(basis_.vectors).front();
  const std::vector<double> equal = relative_steps(basis_, StepRule::kUniform, 3);
  const auto steps = steps_for(basis_, equal, predictor, 0.5);
  const std::vector<double> found = tripled(basis_, steps, predictor);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_GT(found[0], 0.6);
  EXPECT_GT(found[0], found[2]);
}

}  // namespace
}  // namespace rlpc
