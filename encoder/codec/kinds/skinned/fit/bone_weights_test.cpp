#include "encoder/codec/kinds/skinned/fit/bone_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace rlpc {
namespace {

// The errors of each candidate over some frames; their inner products are the Gram matrix.
using Deviations = std::vector<std::vector<double>>;

std::vector<double> gram_of(const Deviations& d, std::size_t stride) {
  // NaN beyond the candidates: must not be read.
  std::vector<double> gram(d.size() * stride, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < d.size(); ++i) {
    for (std::size_t j = 0; j < d.size(); ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < d[i].size(); ++k) sum += d[i][k] * d[j][k];
      gram[i * stride + j] = sum;
    }
  }
  return gram;
}

BoneWeights weights_of(const Deviations& d, std::size_t max, double per_influence = 0.0) {
  return sparse_weights(gram_of(d, d.size() + 2), d.size() + 2, d.size(), max, per_influence);
}

double error_of(const Deviations& d, const std::vector<RigWeight>& weights) {
  double error = 0.0;
  for (std::size_t k = 0; k < d[0].size(); ++k) {
    double sum = 0.0;
    for (const RigWeight& w : weights) sum += w.weight * d[w.bone][k];
    error += sum * sum;
  }
  return error;
}

std::string text(const BoneWeights& found) {
  std::string result;
  for (const RigWeight& w : found.weights) {
    result += std::to_string(w.bone) + ":" + std::to_string(w.weight) + " ";
  }
  return result + "error " + std::to_string(found.error);
}

// Checks that weights are non-negative with sum 1, heaviest first, without duplicates, and that
// the error is that of the blend.
void expect_valid(const Deviations& d, const BoneWeights& found, std::size_t max) {
  ASSERT_GE(found.weights.size(), 1U);
  EXPECT_LE(found.weights.size(), max);
  double sum = 0.0;
  std::vector<std::uint32_t> bones;
  for (const RigWeight& w : found.weights) {
    EXPECT_LT(w.bone, d.size());
    EXPECT_GT(w.weight, 0.0);
    sum += w.weight;
    bones.push_back(w.bone);
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  std::sort(bones.begin(), bones.end());
  EXPECT_EQ(std::adjacent_find(bones.begin(), bones.end()), bones.end());
  EXPECT_TRUE(std::is_sorted(
      found.weights.begin(), found.weights.end(),
      [](const RigWeight& a, const RigWeight& b) { return a.weight > b.weight; }));
  const double size = error_of(d, {{0, 1.0}}) + error_of(d, found.weights);
  EXPECT_NEAR(found.error, error_of(d, found.weights), 1e-12 * size) << text(found);
}

// Returns the lowest error of blends of these candidates, by enumeration with weights in
// multiples of 1/steps.
double min_error(const Deviations& d, const std::vector<std::uint32_t>& bones, int steps) {
  double min = std::numeric_limits<double>::infinity();
  std::vector<RigWeight> weights;
  const auto search = [&](const auto& self, int left) -> void {
    const std::uint32_t bone = bones[weights.size()];
    if (weights.size() + 1 == bones.size()) {
      weights.push_back({bone, static_cast<double>(left) / steps});
      min = std::min(min, error_of(d, weights));
      weights.pop_back();
      return;
    }
    for (int w = 0; w <= left; ++w) {
      weights.push_back({bone, static_cast<double>(w) / steps});
      self(self, left - w);
      weights.pop_back();
    }
  };
  search(search, steps);
  return min;
}

// For orthogonal errors, the optimal weights are inversely proportional to the squared norms.
TEST(SparseWeights, AreExactForOrthogonalErrors) {
  const Deviations d{{0, 2, 0}, {1, 0, 0}, {0, 0, 4}};
  const BoneWeights all = weights_of(d, 3);
  expect_valid(d, all, 3);
  ASSERT_EQ(all.weights.size(), 3U);
  EXPECT_EQ(all.weights[0].bone, 1U);
  EXPECT_EQ(all.weights[1].bone, 0U);
  EXPECT_EQ(all.weights[2].bone, 2U);
  EXPECT_NEAR(all.weights[0].weight, 16.0 / 21.0, 1e-7);
  EXPECT_NEAR(all.weights[1].weight, 4.0 / 21.0, 1e-7);
  EXPECT_NEAR(all.weights[2].weight, 1.0 / 21.0, 1e-7);
  EXPECT_NEAR(all.error, 16.0 / 21.0, 1e-7);

  const BoneWeights two = weights_of(d, 2);
  ASSERT_EQ(two.weights.size(), 2U);
  EXPECT_NEAR(two.weights[0].weight, 0.8, 1e-7);
  EXPECT_NEAR(two.error, 0.8, 1e-7);

  const BoneWeights one = weights_of(d, 1);
  ASSERT_EQ(one.weights.size(), 1U);
  EXPECT_EQ(one.weights[0].bone, 1U);
  EXPECT_EQ(one.weights[0].weight, 1.0);
  EXPECT_EQ(one.error, 1.0);
}

// The second bone lowers the error by 0.2, the third by 0.8 - 16/21, about 0.038.
TEST(SparseWeights, AddABoneThatSavesEnough) {
  const Deviations d{{0, 2, 0}, {1, 0, 0}, {0, 0, 4}};
  EXPECT_EQ(weights_of(d, 4, 0.21).weights.size(), 1U);
  EXPECT_EQ(weights_of(d, 4, 0.19).weights.size(), 2U);
  EXPECT_EQ(weights_of(d, 4, 0.039).weights.size(), 2U);
  EXPECT_EQ(weights_of(d, 4, 0.037).weights.size(), 3U);
}

TEST(SparseWeights, RemoveNegativeWeights) {
  const Deviations same_side{{1, 0}, {2, 0}, {3, 0}};
  const BoneWeights one = weights_of(same_side, 4);
  ASSERT_EQ(one.weights.size(), 1U);
  EXPECT_EQ(one.weights[0].bone, 0U);
  EXPECT_EQ(one.error, 1.0);

  // The first bone is the best single one, but useless once the other two are chosen.
  const Deviations around{{1, 0}, {-0.25, 1.25}, {-0.25, -1.25}};
  const BoneWeights three = weights_of(around, 4);
  expect_valid(around, three, 4);
  EXPECT_LT(three.error, 1e-6);
  const Deviations behind{{1, 0}, {0.25, 1.25}, {0.25, -1.25}};
  const BoneWeights two = weights_of(behind, 4);
  expect_valid(behind, two, 4);
  ASSERT_EQ(two.weights.size(), 2U) << text(two);
  EXPECT_NEAR(two.weights[0].weight, 0.5, 1e-6);
  EXPECT_EQ(two.weights[0].bone + two.weights[1].bone, 3U);
  EXPECT_NEAR(two.error, 0.0625, 1e-6);
}

TEST(SparseWeights, AreOptimalForTwoBones) {
  std::mt19937 random(1);
  const auto value = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  for (int i = 0; i < 100; ++i) {
    Deviations d(2, std::vector<double>(3));
    for (auto& row : d) {
      for (double& x : row) x = value();
    }
    const BoneWeights found = weights_of(d, 4);
    expect_valid(d, found, 2);
    const double min = min_error(d, {0, 1}, 1000);
    EXPECT_LE(found.error, min + 1e-8);
    EXPECT_GE(found.error, min - 1e-5);
  }
}

// Greedy selection is not optimal. But the weights of the chosen bones are optimal, more bones
// are never worse, and no bone that would help is left out.
TEST(SparseWeights, AreOptimalForTheChosenBones) {
  std::mt19937 random(2);
  const auto value = [&] { return static_cast<double>(random()) / 2147483648.0 - 1.0; };
  int sizes[5] = {};
  for (int i = 0; i < 60; ++i) {
    Deviations d(6, std::vector<double>(4));
    const double off = 0.5 * (i % 4);  // common offset of all errors
    for (auto& row : d) {
      for (double& x : row) x = value() + off;
    }
    double before = std::numeric_limits<double>::infinity();
    for (std::size_t max = 1; max <= 4; ++max) {
      const BoneWeights found = weights_of(d, max);
      expect_valid(d, found, max);
      EXPECT_LE(found.error, before);
      before = found.error;
      std::vector<std::uint32_t> bones;
      for (const RigWeight& w : found.weights) bones.push_back(w.bone);
      const double min = min_error(d, bones, 40);
      EXPECT_LE(found.error, min + 1e-7) << text(found);
      if (found.weights.size() == max) continue;
      for (std::uint32_t other = 0; other < d.size(); ++other) {
        if (std::find(bones.begin(), bones.end(), other) != bones.end()) continue;
        bones.push_back(other);
        EXPECT_GE(min_error(d, bones, 20), found.error * (1.0 - 1e-6)) << text(found);
        bones.pop_back();
      }
    }
    ++sizes[weights_of(d, 4).weights.size()];
  }
  EXPECT_GT(sizes[1] + sizes[2], 5);
  EXPECT_GT(sizes[3] + sizes[4], 5);
}

TEST(SparseWeights, UseOneOfIdenticalCandidates) {
  const Deviations d(5, {0.5, -1.0, 0.25});
  const BoneWeights found = weights_of(d, 4);
  expect_valid(d, found, 1);
  EXPECT_EQ(found.weights[0].bone, 0U);
}

TEST(SparseWeights, UseOnlyABoneWithoutError) {
  const BoneWeights found = weights_of({{1, 1}, {0, 0}, {2, -1}, {0, 0}}, 4);
  ASSERT_EQ(found.weights.size(), 1U);
  EXPECT_EQ(found.weights[0].bone, 1U);
  EXPECT_EQ(found.weights[0].weight, 1.0);
  EXPECT_EQ(found.error, 0.0);
  const BoneWeights none = weights_of({{0, 0}, {0, 0}}, 4);
  ASSERT_EQ(none.weights.size(), 1U);
  EXPECT_EQ(none.error, 0.0);
  const BoneWeights alone = weights_of({{3, 4}}, 4);
  ASSERT_EQ(alone.weights.size(), 1U);
  EXPECT_EQ(alone.weights[0].weight, 1.0);
  EXPECT_EQ(alone.error, 25.0);
}

// The result is independent of the unit of length.
TEST(SparseWeights, AreScaleInvariant) {
  const Deviations d{{1, 0.2}, {-0.5, 1}, {0.1, -1.5}};
  const BoneWeights found = weights_of(d, 3);
  ASSERT_EQ(found.weights.size(), 3U);
  for (const double scale : {1e-60, 1e60}) {
    Deviations scaled = d;
    for (auto& row : scaled) {
      for (double& x : row) x *= scale;
    }
    const BoneWeights other = weights_of(scaled, 3);
    ASSERT_EQ(other.weights.size(), found.weights.size()) << scale;
    for (std::size_t i = 0; i < found.weights.size(); ++i) {
      EXPECT_EQ(other.weights[i].bone, found.weights[i].bone);
      EXPECT_NEAR(other.weights[i].weight, found.weights[i].weight, 1e-9);
    }
  }
}

}  // namespace
}  // namespace rlpc
