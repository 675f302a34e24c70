#include "encoder/codec/kinds/skinned/recover/convex_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

using Errors = std::vector<std::vector<double>>;  // [count][dimension]

std::vector<double> gram_of(const Errors& d) {
  std::vector<double> gram;
  for (const auto& a : d) {
    for (const auto& b : d)
      gram.push_back(std::inner_product(a.begin(), a.end(), b.begin(), 0.0));
  }
  return gram;
}

double trace_of(const Errors& d) {
  double sum = 0.0;
  for (const auto& a : d) sum += std::inner_product(a.begin(), a.end(), a.begin(), 0.0);
  return sum;
}

std::vector<double> weights_of(const Errors& d, std::size_t max_count) {
  return convex_weights(gram_of(d), d.size(), max_count);
}

// Returns the squared norm of the combination of the errors.
double objective(const Errors& d, const std::vector<double>& w) {
  double result = 0.0;
  for (std::size_t k = 0; k < d[0].size(); ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < d.size(); ++i) sum += w[i] * d[i][k];
    result += sum * sum;
  }
  return result;
}

double best_single(const Errors& d) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < d.size(); ++i) {
    std::vector<double> w(d.size(), 0.0);
    w[i] = 1.0;
    best = std::min(best, objective(d, w));
  }
  return best;
}

// Solves a x = b by Gaussian elimination, rows of a followed by b. Empty: a is singular.
std::vector<double> solution(std::vector<std::vector<double>> rows) {
  const std::size_t n = rows.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i) {
      if (std::abs(rows[i][k]) > std::abs(rows[pivot][k])) pivot = i;
    }
    if (std::abs(rows[pivot][k]) < 1e-13) return {};
    std::swap(rows[k], rows[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      const double factor = rows[i][k] / rows[k][k];
      if (i == k) continue;
      for (std::size_t j = k; j <= n; ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  std::vector<double> x(n);
  for (std::size_t k = 0; k < n; ++k) x[k] = rows[k][n] / rows[k][k];
  return x;
}

// Returns the smallest objective of convex combinations of some of the errors: for each subset
// of them finds the weights with sum 1 and the smallest objective, by a Lagrange multiplier.
double min_objective(const Errors& d, const std::vector<std::size_t>& of) {
  const std::vector<double> gram = gram_of(d);
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t mask = 1; mask < (std::size_t{1} << of.size()); ++mask) {
    std::vector<std::size_t> subset;
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (((mask >> i) & 1) != 0) subset.push_back(of[i]);
    }
    std::vector<std::vector<double>> rows;
    for (const std::size_t i : subset) {
      std::vector<double>& row = rows.emplace_back();
      for (const std::size_t j : subset) row.push_back(gram[i * d.size() + j]);
      row.insert(row.end(), {1.0, 0.0});
    }
    std::vector<double>& last = rows.emplace_back(subset.size(), 1.0);
    last.insert(last.end(), {0.0, 1.0});
    const std::vector<double> x = solution(rows);
    if (x.empty() || *std::min_element(x.begin(), x.end() - 1) < 0.0) continue;
    std::vector<double> w(d.size(), 0.0);
    for (std::size_t i = 0; i < subset.size(); ++i) w[subset[i]] = x[i];
    min = std::min(min, objective(d, w));
  }
  return min;
}

double min_objective(const Errors& d) {
  std::vector<std::size_t> all(d.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return min_objective(d, all);
}

void expect_convex(const std::vector<double>& w, std::size_t count, std::size_t max_count) {
  ASSERT_EQ(w.size(), count);
  for (const double x : w) EXPECT_GE(x, 0.0);
  EXPECT_NEAR(std::accumulate(w.begin(), w.end(), 0.0), 1.0, 1e-12);
  const auto num_used = std::count_if(w.begin(), w.end(), [](double x) { return x > 0.0; });
  EXPECT_LE(static_cast<std::size_t>(num_used), max_count);
}

class RandomErrors {
 public:
  explicit RandomErrors(unsigned seed) : random_(seed) {}
  double value() { return static_cast<double>(random_()) / 2147483648.0 - 1.0; }  // -1 to 1
  // Returns errors of various sizes that have `offset` in common.
  Errors errors(std::size_t count, std::size_t dimension, double offset) {
    Errors d(count, std::vector<double>(dimension));
    for (auto& row : d) {
      const double size = 0.2 + std::abs(value());
      for (double& x : row) x = size * value() + offset;
    }
    return d;
  }

 private:
  std::mt19937 random_;
};

TEST(ConvexWeights, HaveTheLeastObjective) {
  RandomErrors random(1);
  std::vector<int> used(8, 0);  // cases that need this many errors
  for (std::size_t i = 0; i < 1500; ++i) {
    const std::size_t count = 1 + i % 7;
    const std::size_t dimension = 1 + i / 7 % 9;  // often less than the errors
    const Errors d = random.errors(count, dimension, 0.3 * static_cast<double>(i / 63 % 3));
    const std::vector<double> w = weights_of(d, count);
    expect_convex(w, count, count);
    const double min = min_objective(d);
    const double tolerance = 1e-9 * min + 1e-11 * trace_of(d);
    EXPECT_NEAR(objective(d, w), min, tolerance) << i;
    ++used[static_cast<std::size_t>(
        std::count_if(w.begin(), w.end(), [](double x) { return x > 0.0; }))];
  }
  for (std::size_t n = 1; n <= 5; ++n) EXPECT_GT(used[n], 20) << n;
}

// The errors with the largest weights are kept, and weighted as well as is possible for them.
TEST(ConvexWeights, AreAtMostTheLargestOnes) {
  RandomErrors random(2);
  int limited = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    const std::size_t count = 3 + i % 5;
    const Errors d = random.errors(count, 8, 0.0);
    const std::vector<double> all = weights_of(d, count);
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return all[a] > all[b]; });
    for (std::size_t max_count = 1; max_count < count; ++max_count) {
      const std::vector<double> w = weights_of(d, max_count);
      expect_convex(w, count, max_count);
      if (all[order[max_count]] == 0.0) {
        EXPECT_EQ(w, all);
        continue;
      }
      ++limited;
      const std::vector<std::size_t> kept(
          order.begin(), order.begin() + static_cast<std::ptrdiff_t>(max_count));
      const double min = min_objective(d, kept);
      EXPECT_NEAR(objective(d, w), min, 1e-9 * min + 1e-11 * trace_of(d)) << i;
      EXPECT_GT(objective(d, w), objective(d, all));
    }
  }
  EXPECT_GT(limited, 300);
}

TEST(ConvexWeights, LeaveNothingOfAnExactBlend) {
  RandomErrors random(3);
  for (std::size_t i = 0; i < 300; ++i) {
    const std::size_t count = 2 + i % 4;
    // The errors are affinely independent, so that the blend is unique.
    Errors d = random.errors(count, 8, 0.0);
    std::vector<double> blend(count);
    for (double& x : blend) x = 0.1 + std::abs(random.value());
    const double sum = std::accumulate(blend.begin(), blend.end(), 0.0);
    for (double& x : blend) x /= sum;
    for (std::size_t k = 0; k < 8; ++k) {
      d[0][k] = 0.0;
      for (std::size_t j = 1; j < count; ++j) d[0][k] -= blend[j] / blend[0] * d[j][k];
    }
    // A further error is of no use.
    d.push_back(random.errors(1, 8, 0.0)[0]);
    const std::vector<double> w = weights_of(d, count + 1);
    expect_convex(w, count + 1, count + 1);
    EXPECT_LT(objective(d, w), 1e-14 * trace_of(d)) << i;
    for (std::size_t j = 0; j < count; ++j) EXPECT_NEAR(w[j], blend[j], 1e-6) << i;
    EXPECT_LT(w[count], 1e-6) << i;
  }
}

// The first error is the smallest, but useless once the other two are combined.
TEST(ConvexWeights, DropAnErrorThatBecameUseless) {
  const std::vector<double> w = weights_of({{1, 0}, {0.25, 1.25}, {0.25, -1.25}}, 3);
  expect_convex(w, 3, 2);
  EXPECT_EQ(w[0], 0.0);
  EXPECT_NEAR(w[1], 0.5, 1e-9);
  EXPECT_NEAR(w[2], 0.5, 1e-9);
}

TEST(ConvexWeights, AreAnyForErrorsThatAreAlike) {
  for (std::size_t count = 1; count <= 6; ++count) {
    const Errors d(count, {0.5, -1.0, 0.25});
    for (std::size_t max_count = 1; max_count <= count; ++max_count) {
      const std::vector<double> w = weights_of(d, max_count);
      expect_convex(w, count, max_count);
      EXPECT_NEAR(objective(d, w), best_single(d), 1e-12);
    }
  }
}

TEST(ConvexWeights, AreConvexWithoutErrors) {
  for (std::size_t count = 1; count <= 5; ++count) {
    const std::vector<double> none(count * count, 0.0);
    expect_convex(convex_weights(none, count, 2), count, 2);
  }
  // One of several has none.
  const std::vector<double> w = weights_of({{1, 1}, {0, 0}, {2, 1}}, 3);
  EXPECT_EQ(w, (std::vector<double>{0.0, 1.0, 0.0}));
}

TEST(ConvexWeights, AreOneForASingleError) {
  EXPECT_EQ(weights_of({{3, 4}}, 1), (std::vector<double>{1.0}));
  EXPECT_EQ(weights_of({{3, 4}}, 4), (std::vector<double>{1.0}));
}

// The result is independent of the unit of length.
TEST(ConvexWeights, AreScaleInvariant) {
  RandomErrors random(4);
  const Errors d = random.errors(5, 8, 0.1);
  const std::vector<double> w = weights_of(d, 4);
  for (const double scale : {1e-40, 1e40}) {
    Errors scaled = d;
    for (auto& row : scaled) {
      for (double& x : row) x *= scale;
    }
    const std::vector<double> other = weights_of(scaled, 4);
    for (std::size_t i = 0; i < w.size(); ++i) EXPECT_NEAR(other[i], w[i], 1e-9) << scale;
  }
}

}  // namespace
}  // namespace rlpc
