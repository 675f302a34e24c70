#include "encoder/codec/math/eigenvectors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "encoder/testing/dot.h"

namespace rlpc {
namespace {

// A symmetric matrix with the given eigenvalues; all others are `floor`. The eigenvectors are
// the axes reflected by I - 2 h h^T.
struct Known {
  std::vector<double> matrix;
  std::vector<double> h;

  Known(std::size_t width, const std::vector<double>& values, double floor) {
    std::mt19937 random(7);
    h.resize(width);
    for (double& x : h) x = static_cast<double>(random() % 2001) / 1000.0 - 1.0;
    const double norm = std::sqrt(dot(h, h));
    for (double& x : h) x /= norm;
    matrix.assign(width * width, 0.0);
    for (std::size_t l = 0; l < width; ++l) {
      const double value = l < values.size() ? values[l] : floor;
      const std::vector<double> v = vector(l);
      for (std::size_t i = 0; i < width; ++i) {
        for (std::size_t j = 0; j <= i; ++j) matrix[i * width + j] += value * v[i] * v[j];
      }
    }
  }
  std::vector<double> vector(std::size_t l) const {
    std::vector<double> v(h.size());
    for (std::size_t i = 0; i < v.size(); ++i) v[i] = (i == l ? 1.0 : 0.0) - 2.0 * h[i] * h[l];
    return v;
  }
};

struct Case {
  std::size_t width;
  std::size_t count;  // number of values above 1
  double floor;
};

class LeadingEigenvectors : public testing::TestWithParam<Case> {};

TEST_P(LeadingEigenvectors, AreFoundWithTheirValues) {
  const auto [width, count, floor] = GetParam();
  std::vector<double> values;
  for (std::size_t l = 0; l < count; ++l) values.push_back(1e6 / std::pow(1.1, l));
  const Known known(width, values, floor);
  const EigenPairs pairs = leading_eigenvectors(known.matrix, width, width, 1.0);
  ASSERT_EQ(pairs.vectors.size(), count);
  ASSERT_GE(pairs.values.size(), count);
  for (std::size_t l = 0; l < count; ++l) {
    EXPECT_NEAR(pairs.values[l], values[l], 1e-4 * values[l]) << l;
    EXPECT_NEAR(std::abs(dot(pairs.vectors[l], known.vector(l))), 1.0, 1e-3) << l;
    for (std::size_t k = 0; k < l; ++k) {
      EXPECT_NEAR(dot(pairs.vectors[l], pairs.vectors[k]), 0.0, 1e-9);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(NarrowAndWideFewAndMany, LeadingEigenvectors,
                         testing::Values(Case{1, 1, 0.0}, Case{60, 12, 0.2}, Case{60, 50, 0.2},
                                         Case{300, 0, 0.1}, Case{400, 140, 0.4},
                                         Case{620, 0, 0.1}, Case{620, 12, 0.0},
                                         Case{620, 40, 0.3}, Case{620, 140, 0.4}));

TEST(LeadingEigenvectors, AreAtMostMaxCount) {
  for (const std::size_t width : {300U, 620U}) {
    const Known known(width, {9.0, 8.0, 5.0, 4.0}, 0.1);
    const EigenPairs pairs = leading_eigenvectors(known.matrix, width, 2, 1.0);
    ASSERT_EQ(pairs.vectors.size(), 2U);
    EXPECT_NEAR(pairs.values[1], 8.0, 1e-6);
  }
}

TEST(LeadingEigenvectors, AreNoneForAZeroMatrix) {
  for (const std::size_t width : {300U, 620U}) {
    const std::vector<double> zeros(width * width, 0.0);
    EXPECT_TRUE(leading_eigenvectors(zeros, width, width, 0.0).vectors.empty());
  }
}

}  // namespace
}  // namespace rlpc
