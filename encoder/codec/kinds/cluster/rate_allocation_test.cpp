#include "encoder/codec/kinds/cluster/rate_allocation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace rlpc {
namespace {

using Choice = std::vector<std::size_t>;

RdPoint total(const std::vector<RdCurve>& curves, const Choice& choice) {
  RdPoint sum;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    sum.rate += curves[i][choice[i]].rate;
    sum.distortion += curves[i][choice[i]].distortion;
  }
  return sum;
}

// Returns all combinations of points, by enumeration.
std::vector<Choice> all_choices(const std::vector<RdCurve>& curves) {
  std::vector<Choice> all{Choice(curves.size(), 0)};
  for (Choice choice = all.front();;) {
    std::size_t i = 0;
    while (i < curves.size() && ++choice[i] == curves[i].size()) choice[i++] = 0;
    if (i == curves.size()) return all;
    all.push_back(choice);
  }
}

// Returns the lowest distortion of all choices within a rate.
double min_distortion(const std::vector<RdCurve>& curves, double rate) {
  double min = std::numeric_limits<double>::infinity();
  for (const Choice& choice : all_choices(curves)) {
    const RdPoint sum = total(curves, choice);
    if (sum.rate <= rate) min = std::min(min, sum.distortion);
  }
  return min;
}

// Returns convex curves, in which each step saves less than the one before, with integer
// values, so that sums are exact.
std::vector<RdCurve> random_curves(std::mt19937& random, bool unit_rates, bool convex) {
  std::vector<RdCurve> curves(1 + random() % 4);
  for (RdCurve& curve : curves) {
    std::vector<double> savings(random() % 6);
    for (double& s : savings) s = static_cast<double>(random() % 1000);
    if (convex) std::sort(savings.rbegin(), savings.rend());
    curve = {{0.0, 5000.0}};
    for (const double s : savings) {
      const double rate = unit_rates ? 1.0 : 1.0 + static_cast<double>(random() % 20);
      curve.push_back({curve.back().rate + rate, curve.back().distortion - s});
    }
  }
  return curves;
}

TEST(AllocateWithin, IsOptimalForConvexCurvesInVectors) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::vector<RdCurve> curves = random_curves(random, true, true);
    for (int budget = 0; budget <= 15; ++budget) {
      const RdPoint sum = total(curves, allocate_within(curves, budget));
      EXPECT_LE(sum.rate, budget);
      EXPECT_EQ(sum.distortion, min_distortion(curves, budget));
    }
  }
}

TEST(AllocateWithin, NeverExceedsItsBudget) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::vector<RdCurve> curves = random_curves(random, false, false);
    for (int i = 0; i < 35; ++i) {
      const double budget = 3.5 * i;
      EXPECT_LE(total(curves, allocate_within(curves, budget)).rate, budget);
    }
  }
}

// On curves of any shape, points on the hulls are optimal for the bits that they use.
TEST(AllocateWithin, IsOptimalAtTheRateOfASlope) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const std::vector<RdCurve> curves = random_curves(random, false, false);
    for (const double lambda : {0.5, 3.1, 10.3, 25.7, 60.1, 200.9}) {
      Choice by_slope;
      for (const RdCurve& curve : curves) by_slope.push_back(allocate_by_slope(curve, lambda));
      const double budget = total(curves, by_slope).rate;
      const RdPoint sum = total(curves, allocate_within(curves, budget));
      EXPECT_EQ(sum.rate, budget);
      EXPECT_EQ(sum.distortion, min_distortion(curves, budget));
    }
  }
}

TEST(AllocateWithin, TakesFlatterStepsIfASteepOneDoesNotFit) {
  const std::vector<RdCurve> curves{{{0, 100}, {10, 0}}, {{0, 100}, {2, 95}, {4, 94}}};
  EXPECT_EQ(allocate_within(curves, 9), (Choice{0, 2}));
  EXPECT_EQ(allocate_within(curves, 10), (Choice{1, 0}));
  EXPECT_EQ(allocate_within(curves, 12), (Choice{1, 1}));
  EXPECT_EQ(allocate_within(curves, 100), (Choice{1, 2}));
}

// A further component can increase distortion, or cost bits without reducing distortion; such
// points are not on the hull.
TEST(AllocateWithin, SkipsPointsAboveTheHull) {
  const std::vector<RdCurve> curves{{{0, 100}, {5, 99}, {6, 20}, {7, 30}}};
  EXPECT_EQ(allocate_within(curves, 5), Choice{0});
  EXPECT_EQ(allocate_within(curves, 6), Choice{2});
  EXPECT_EQ(allocate_within(curves, 100), Choice{2});
}

TEST(AllocateWithin, PrefersTheLowerIndexInATie) {
  const std::vector<RdCurve> curves(3, RdCurve{{0, 10}, {1, 5}});
  EXPECT_EQ(allocate_within(curves, 1), (Choice{1, 0, 0}));
  EXPECT_EQ(allocate_within(curves, 2), (Choice{1, 1, 0}));
}

TEST(AllocateWithin, IsEmptyWithoutCurves) {
  EXPECT_EQ(allocate_within({}, 10), Choice{});
  EXPECT_EQ(allocate_within({{{0, 7}}}, 10), Choice{0});
}

TEST(AllocateBySlope, MinimisesTheLagrangianCost) {
  for (unsigned seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    for (const RdCurve& curve : random_curves(random, seed % 3 == 0, seed % 2 == 0)) {
      for (const double lambda : {0.0625, 1.5, 7.25, 30.5, 111.25, 800.5}) {
        double min = std::numeric_limits<double>::infinity();
        for (const RdPoint& p : curve) min = std::min(min, p.distortion + lambda * p.rate);
        const RdPoint& chosen = curve[allocate_by_slope(curve, lambda)];
        EXPECT_NEAR(chosen.distortion + lambda * chosen.rate, min, 1e-9);
      }
    }
  }
}

TEST(AllocateBySlope, TakesFewerComponentsAsLambdaGrows) {
  const RdCurve curve{{0, 1000}, {10, 500}, {20, 300}, {30, 290}};
  EXPECT_EQ(allocate_by_slope(curve, 60.0), 0U);
  EXPECT_EQ(allocate_by_slope(curve, 50.0), 0U);  // a unit of rate has to save more than lambda
  EXPECT_EQ(allocate_by_slope(curve, 49.0), 1U);
  EXPECT_EQ(allocate_by_slope(curve, 19.0), 2U);
  EXPECT_EQ(allocate_by_slope(curve, 0.5), 3U);
}

}  // namespace
}  // namespace rlpc
