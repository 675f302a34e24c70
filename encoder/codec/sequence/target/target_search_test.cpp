#include "encoder/codec/sequence/target/target_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <random>

namespace rlpc {
namespace {

constexpr int kEnough = 100;  // every search must end before
constexpr double kStepOfError = 6.0;
constexpr AnalysisRange kRange{.finest = 1.0 / 1.2, .made_for = 1.0, .coarsest = 1.2};

struct Outcome {
  double best = 0.0;  // measured value of the encoding reported as best
  double best_step = 0.0;
  double min = std::numeric_limits<double>::infinity();  // least measured value
  int trials = 0;
  bool met = false;
};

// Coarser steps take fewer bytes.
std::uint64_t bytes_with(double step) { return static_cast<std::uint64_t>(1e12 / step); }

// Runs a search; measure(step) replaces encoding.
Outcome search(const Target& target, const std::function<double(double)>& measure,
               double spread = 10000.0, double steps_per_unit = 1000.0) {
  TargetSearch s(target, spread, steps_per_unit, kStepOfError, kRange);
  Outcome outcome;
  while (!s.finished() && outcome.trials < kEnough) {
    const double step = s.step();
    EXPECT_GE(step, 0.5);
    EXPECT_LE(step, 0x1p24);
    const double measured = measure(step);
    outcome.min = std::min(outcome.min, measured);
    ++outcome.trials;
    if (s.report(measured, bytes_with(step))) {
      outcome.best = measured;
      outcome.best_step = step;
    }
    EXPECT_EQ(s.last_step(), step);
  }
  outcome.met = s.met();
  return outcome;
}

void expect_near(const Target& target, const Outcome& outcome) {
  EXPECT_LT(outcome.trials, kEnough);
  EXPECT_TRUE(outcome.met);
  EXPECT_LE(outcome.best, target.value);
  const double tolerance = target.kind == Target::kMaxError ? 0.02 : 0.006;
  EXPECT_GE(outcome.best, (1.0 - tolerance) * target.value);
}

TEST(TargetSearch, WithoutTargetTakesOneTrial) {
  const Outcome outcome = search({Target::kNone, 0.0}, [](double step) { return step; });
  EXPECT_EQ(outcome.trials, 1);
  EXPECT_TRUE(outcome.met);
}

// Errors are powers of the step, with exponents from 1/2 to 2.
TEST(TargetSearch, ReachesAnErrorFromBelow) {
  for (const Target::Kind kind : {Target::kKg, Target::kMaxError}) {
    for (const double value : {0.003, 0.1, 2.0}) {
      for (const double power : {0.5, 0.8, 1.0, 1.3, 2.0}) {
        for (const double factor : {0.02, 1.0, 30.0}) {
          SCOPED_TRACE(testing::Message() << value << " " << power << " " << factor);
          const Target target{kind, value};
          // The step that meets the target is well within the range of steps.
          const double at = 300.0 * factor;
          expect_near(target, search(target, [&](double step) {
                        return value * std::pow(step / at, power);
                      }));
        }
      }
    }
  }
}

// The rate falls as the step grows, towards that of headers and connectivity.
TEST(TargetSearch, ReachesARateFromBelow) {
  for (const double value : {0.3, 1.0, 6.0}) {
    for (const double power : {0.3, 0.5, 1.0}) {
      for (const double factor : {0.02, 1.0, 30.0}) {
        SCOPED_TRACE(testing::Message() << value << " " << power << " " << factor);
        const Target target{Target::kBpvf, value};
        const double at = 300.0 * factor;
        expect_near(target, search(target, [&](double step) {
                      return 0.2 * value + 0.8 * value * std::pow(step / at, -power);
                    }));
      }
    }
  }
}

// With noisy values the search may not converge, but it must report its result correctly.
TEST(TargetSearch, ReportsTheClosestFromBelowOfNoisyMeasurements) {
  int within = 0;
  int all = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const bool rate = seed % 3 == 0;
    const Target target{rate            ? Target::kBpvf
                        : seed % 3 == 1 ? Target::kKg
                                        : Target::kMaxError,
                        1.0};
    double closest = 0.0;
    const Outcome outcome = search(target, [&](double step) {
      const double noise = 1.0 + 0.0015 * (static_cast<double>(random() % 2001) / 1000.0 - 1.0);
      const double measured = noise * std::pow(step / 900.0, rate ? -0.5 : 0.9);
      if (measured <= 1.0) closest = std::max(closest, measured);
      return measured;
    });
    EXPECT_LT(outcome.trials, kEnough);
    EXPECT_TRUE(outcome.met);
    EXPECT_LE(outcome.best, 1.0);
    EXPECT_EQ(outcome.best, closest);
    if (outcome.best >= (seed % 3 == 2 ? 0.98 : 0.994)) ++within;
    ++all;
  }
  EXPECT_GE(within, all * 95 / 100);
}

// Ends on the last step below the target if values are a staircase, as maximum errors often
// are.
TEST(TargetSearch, EndsOnTheLastStairBelowTheTarget) {
  const Outcome outcome =
      search({Target::kMaxError, 1.0}, [](double step) { return step < 700.0 ? 0.6 : 1.5; });
  EXPECT_LT(outcome.trials, kEnough);
  EXPECT_TRUE(outcome.met);
  EXPECT_EQ(outcome.best, 0.6);
}

TEST(TargetSearch, PrefersTheErrorClosestToTheTargetUnlessAnotherSavesBytes) {
  for (const Target::Kind kind : {Target::kKg, Target::kMaxError}) {
    TargetSearch search({kind, 1.0}, 10000.0, 1000.0, kStepOfError, kRange);
    EXPECT_TRUE(search.report(3.0, 10));
    EXPECT_FALSE(search.report(4.0, 5));
    EXPECT_TRUE(search.report(2.0, 20));
    EXPECT_TRUE(search.report(0.5, 1000));
    EXPECT_TRUE(search.report(0.7, 1010));
    EXPECT_FALSE(search.report(0.8, 1200));
    EXPECT_FALSE(search.report(1.2, 10));
    EXPECT_TRUE(search.report(0.9, 1100));
    EXPECT_FALSE(search.report(0.8, 1050));
    EXPECT_TRUE(search.report(0.8, 900));
    EXPECT_TRUE(search.met());
  }
}

TEST(TargetSearch, PrefersTheHighestRateWithinTheTarget) {
  TargetSearch search({Target::kBpvf, 1.0}, 10000.0, 1000.0, kStepOfError, kRange);
  EXPECT_TRUE(search.report(2.0, 2000));
  EXPECT_TRUE(search.report(0.5, 500));
  EXPECT_FALSE(search.report(0.4, 400));
  EXPECT_TRUE(search.report(0.9, 900));
}

TEST(TargetSearch, FindsASmallerMaximumErrorBeyondAJump) {
  const Outcome outcome = search({Target::kMaxError, 1.0}, [](double step) {
    const bool lucky = step > 704.0 && step < 709.0;
    return step < 700.0 ? 0.6 : lucky ? 0.9 : 1.5;
  });
  EXPECT_LT(outcome.trials, kEnough);
  EXPECT_EQ(outcome.best, 0.9);
}

// Returns errors that level off at coarse steps, both as measured and as expected.
double expected_error(double step) { return step / 400.0 / std::sqrt(1.0 + step * step / 1e6); }

int trials_with(const TargetSearch::Expected& expected, double value, double factor) {
  const Target target{Target::kKg, value};
  TargetSearch search(target, 10000.0, 1000.0, kStepOfError, kRange);
  search.begin_at(expected);
  Outcome outcome;
  while (!search.finished() && outcome.trials < kEnough) {
    const double measured = factor * expected_error(search.step());
    ++outcome.trials;
    const std::uint64_t bytes = bytes_with(search.step());
    if (search.report(measured, bytes, expected)) outcome.best = measured;
  }
  outcome.met = search.met();
  expect_near(target, outcome);
  return outcome.trials;
}

TEST(TargetSearch, TakesTwoTrialsIfTheExpectationIsOffByAFactor) {
  for (const double value : {0.2, 0.5, 0.9}) {
    EXPECT_EQ(trials_with(expected_error, value, 0.998), 1);
    for (const double factor : {0.7, 0.9, 1.1, 1.4}) {
      SCOPED_TRACE(testing::Message() << value << " " << factor);
      EXPECT_LE(trials_with(expected_error, value, factor), 2);
    }
  }
}

TEST(TargetSearch, FindsItsTargetDespiteWrongExpectations) {
  for (const double factor : {0.3, 1.0, 5.0}) {
    SCOPED_TRACE(factor);
    trials_with([](double) { return 0.0; }, 0.5, factor);
    trials_with([](double) { return 7.0; }, 0.5, factor);
    trials_with([](double step) { return 1.0 / step; }, 0.5, factor);
    trials_with([](double step) { return step * step * step; }, 0.5, factor);
  }
}

// The analysis of an expectation is not that of the first encoding, however close.
TEST(TargetSearch, AnalysesAnewForTheExpectedStep) {
  const AnalysisRange range{.finest = 0.9, .made_for = 1.25, .coarsest = 1.6};
  for (const double factor : {0.85, 0.95, 1.5, 1.7}) {
    TargetSearch search({Target::kKg, 0.5}, 10000.0, 1000.0, kStepOfError, range);
    const double made = search.analysis_step();
    EXPECT_DOUBLE_EQ(made, search.step() / 1.25);
    // Aims at the middle of the tolerance.
    search.begin_at([&](double step) { return 0.997 * 0.5 * step / (factor * made); });
    EXPECT_NEAR(search.step(), factor * made, 1e-3 * made);
    EXPECT_DOUBLE_EQ(search.analysis_step(), search.step() / 1.25);
  }
}

TEST(TargetSearch, KeepsTheAnalysisForStepsThatItIsValidFor) {
  const AnalysisRange range{.finest = 0.9, .made_for = 1.25, .coarsest = 1.6};
  TargetSearch search({Target::kKg, 0.5}, 10000.0, 1000.0, kStepOfError, range);
  const double made = search.analysis_step();
  search.report(0.55, 1000);
  EXPECT_LT(search.step(), 1.25 * made);
  EXPECT_EQ(search.analysis_step(), made);
}

// No step gives an error near the target, as where one more trajectory is worth coding.
TEST(TargetSearch, EndsSoonWhereTheErrorJumps) {
  const Outcome outcome = search({Target::kKg, 1.0}, [](double step) {
    return step / 700.0 * (step < 700.0 ? 0.93 : 1.04);
  });
  EXPECT_TRUE(outcome.met);
  EXPECT_GT(outcome.best, 0.85);
  EXPECT_LE(outcome.trials, 7);
}

// Errors that are powers of the step are near by then.
TEST(TargetSearch, EndsAfterFiveEncodingsIfTheyAreCostly) {
  for (const double power : {0.3, 0.5, 0.8, 1.0, 1.3}) {
    for (const double factor : {0.02, 1.0, 30.0}) {
      SCOPED_TRACE(testing::Message() << power << " " << factor);
      TargetSearch s({Target::kKg, 0.1}, 10000.0, 1000.0, kStepOfError, kRange);
      s.set_costly();
      s.begin_at(100.0 * factor);
      int trials = 0;
      double best = 0.0;
      while (!s.finished() && trials < kEnough) {
        const double measured = 0.1 * std::pow(s.step() / (110.0 * factor), power);
        ++trials;
        if (s.report(measured, bytes_with(s.step()))) best = measured;
      }
      EXPECT_LE(trials, 5);
      EXPECT_LE(best, 0.1);
      EXPECT_GE(best, 0.0994);
    }
  }
}

TEST(TargetSearch, EndsNearTheTargetIfItIsQuick) {
  int sum = 0;
  int sum_of_quick = 0;
  for (const double power : {0.3, 0.5, 0.8, 1.0, 1.3}) {
    for (const bool quick : {false, true}) {
      SCOPED_TRACE(testing::Message() << power << " " << quick);
      TargetSearch s({Target::kKg, 0.1}, 10000.0, 1000.0, kStepOfError, kRange);
      if (quick) s.set_quick();
      s.begin_at(100.0);
      double best = 0.0;
      for (int i = 0; !s.finished() && i < kEnough; ++i) {
        const double measured = 0.1 * std::pow(s.step() / 110.0, power);
        if (s.report(measured, bytes_with(s.step()))) best = measured;
        ++(quick ? sum_of_quick : sum);
      }
      EXPECT_LE(best, 0.1);
      EXPECT_GE(best, quick ? 0.098 : 0.0994);
    }
  }
  EXPECT_LT(sum_of_quick, sum);
}

TEST(TargetSearch, EndsWithTheSmallestErrorIfTheTargetIsUnreachable) {
  for (const double floor : {0.11, 3.0}) {
    const Outcome outcome =
        search({Target::kKg, 0.1}, [&](double step) { return std::max(floor, 0.001 * step); });
    EXPECT_LT(outcome.trials, kEnough);
    EXPECT_FALSE(outcome.met);
    EXPECT_EQ(outcome.best, floor);
    EXPECT_EQ(outcome.best, outcome.min);
  }
}

TEST(TargetSearch, EndsWithTheSmallestRateIfTheTargetIsUnreachable) {
  const Outcome outcome =
      search({Target::kBpvf, 0.1}, [](double step) { return 0.5 + 1.0 / step; });
  EXPECT_LT(outcome.trials, kEnough);
  EXPECT_FALSE(outcome.met);
  EXPECT_EQ(outcome.best, outcome.min);
}

TEST(TargetSearch, MeetsTheTargetIfTheErrorIsAlwaysZero) {
  for (const Target::Kind kind : {Target::kKg, Target::kMaxError, Target::kBpvf}) {
    const Outcome outcome = search({kind, 0.1}, [](double) { return 0.0; });
    EXPECT_LT(outcome.trials, kEnough);
    EXPECT_TRUE(outcome.met);
    EXPECT_EQ(outcome.best, 0.0);
  }
}

TEST(TargetSearch, EndsWithTheCoarsestOrFinestStepForLooseTargets) {
  const Outcome error =
      search({Target::kKg, 50.0}, [](double step) { return 10.0 * step / 0x1p24; });
  EXPECT_TRUE(error.met);
  EXPECT_EQ(error.best_step, 0x1p24);
  const Outcome rate = search({Target::kBpvf, 90.0}, [](double step) { return 10.0 / step; });
  EXPECT_TRUE(rate.met);
  EXPECT_EQ(rate.best_step, 0.5);
}

TEST(TargetSearch, EndsDespiteInfiniteAndZeroMeasurements) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Target::Kind kind : {Target::kKg, Target::kMaxError}) {
    const Outcome outcome = search(
        {kind, 0.1}, [&](double) { return infinity; }, 0.0);
    EXPECT_LT(outcome.trials, kEnough);
    EXPECT_FALSE(outcome.met);
    const Outcome jump =
        search({kind, 0.1}, [&](double step) { return step < 100.0 ? 0.0 : infinity; });
    EXPECT_LT(jump.trials, kEnough);
    EXPECT_TRUE(jump.met);
    EXPECT_EQ(jump.best, 0.0);
  }
}

}  // namespace
}  // namespace rlpc
