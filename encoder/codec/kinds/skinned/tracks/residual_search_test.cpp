#include "encoder/codec/kinds/skinned/tracks/residual_search.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "encoder/codec/kinds/skinned/tracks/track_series.h"
#include "encoder/codec/write/write_track.h"

namespace rlpc {
namespace {

// Places come after those that predict them, and levels keep their order.
TEST(SearchOrder, HasNeighboursFirst) {
  for (const std::uint32_t num_frames : {1U, 2U, 7U, 64U, 100U}) {
    for (int levels = 0; levels <= 5; ++levels) {
      for (int between = 1; between <= kMaxBetween; ++between) {
        std::vector<bool> known(num_frames, false);
        std::vector<std::int64_t> last(6, -1);
        for (const TrackPlace& at : search_order(track_order(num_frames, levels, between))) {
          const auto f = std::int64_t{at.frame};
          const auto s = std::int64_t{at.stride};
          for (const std::int64_t k : {-3, -1, 1, 3}) {
            if (at.neighbours < (k * k > 1 ? 4 : 2)) continue;
            EXPECT_TRUE(known[static_cast<std::size_t>(f + k * s)]) << f;
          }
          for (std::int64_t k = 1; k <= 4 && at.neighbours == 0 && k * s <= f; ++k) {
            EXPECT_TRUE(known[static_cast<std::size_t>(f - k * s)]) << f;
          }
          known[at.frame] = true;
          EXPECT_GT(f, last[static_cast<std::size_t>(at.level)]);
          last[static_cast<std::size_t>(at.level)] = f;
        }
      }
    }
  }
}

TEST(SearchOrder, GoesOnAsSoonAsItCan) {
  std::vector<std::uint32_t> frames;
  for (const TrackPlace& at : search_order(track_order(9, 2, 1))) frames.push_back(at.frame);
  EXPECT_EQ(frames, (std::vector<std::uint32_t>{0, 4, 2, 1, 3, 8, 6, 5, 7}));
}

TEST(ResidualBits, AreThoseOfTheRigs) {
  ResidualModels models;
  ResidualBits bits;
  bits.start(models);
  for (const std::uint32_t expected : {0U, 5U, 40U, 5U, 100U, 0U}) {
    for (std::int32_t x = -10; x <= 10; ++x) {
      BitEstimate estimate;
      write_residual(estimate, models, expected, x);
      EXPECT_EQ(bits.of(expected, x), estimate.bits());
    }
  }
}

using Values = std::vector<std::array<double, 3>>;

// Returns the Lagrangian cost of residuals in closed loop.
double cost_of(const Values& values, const Trajectory& t, const TrackState& before,
               const TrackResiduals& residuals) {
  Trajectory coded = t;
  coded.residual = residuals;
  const std::vector<TrackPlace> order =
      track_order(static_cast<std::uint32_t>(values.size()), 0, 0);
  double error = 0.0;
  std::vector<Vec3i> decoded;
  for (const TrackPlace& at : order) {
    Vec3i now{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto known = [&](std::uint32_t f) { return std::int64_t{decoded[f][c]}; };
      now[c] =
          static_cast<std::int32_t>(predict_trajectory(t, known, at)) + residuals[at.frame][c];
      error += (values[at.frame][c] - now[c]) * (values[at.frame][c] - now[c]);
    }
    decoded.push_back(now);
  }
  TrackState state = before;
  BitCost bits;
  write_track(bits, state.models, state.mean, order, residuals);
  return error + kLambda * bits.bits();
}

// In short tracks, the search finds nearly the best of all roundings of a coordinate; it cannot
// find the best, as the models adapt along one survivor.
TEST(ResidualSearch, FindsNearlyTheBestRoundings) {
  constexpr std::uint32_t kFrames = 8;
  std::uint32_t random = 7;
  double sum_best = 0.0;
  double sum_found = 0.0;
  double sum_nearest = 0.0;
  for (int i = 0; i < 20; ++i) {
    Values values(kFrames);
    for (auto& value : values) {
      random = random * 1664525U + 1013904223U;
      value = {static_cast<double>(random >> 16) / 32768.0, 0.0, 0.0};
    }
    Trajectory t;
    t.temporal_predictor = 1;
    const TrackState before(kFrames);
    const auto cost_of_rounding = [&](const auto& rounded) {
      TrackResiduals residuals(kFrames);
      std::int32_t last = 0;
      for (std::size_t f = 0; f < kFrames; ++f) {
        const std::int32_t now = rounded(f);
        residuals[f][0] = now - last;
        last = now;
      }
      return cost_of(values, t, before, residuals);
    };
    double best = std::numeric_limits<double>::infinity();
    for (std::uint32_t up = 0; up < 1U << kFrames; ++up) {
      best = std::min(best, cost_of_rounding([&](std::size_t f) {
                        return static_cast<std::int32_t>(std::floor(values[f][0])) +
                               static_cast<std::int32_t>(up >> f & 1U);
                      }));
    }
    sum_best += best;
    sum_nearest += cost_of_rounding(
        [&](std::size_t f) { return static_cast<std::int32_t>(std::lround(values[f][0])); });
    const TrajectorySeries series(values, t);
    const std::vector<TrackPlace> order = track_order(kFrames, 0, 0);
    ResidualSearch<TrajectorySeries> search(series, order, before, {4, 3});
    TrackResiduals found(kFrames);
    search.improve(0, found);
    const double cost = cost_of(values, t, before, found);
    EXPECT_GE(cost, best * (1.0 - 1e-12));
    sum_found += cost;
  }
  EXPECT_LT(sum_found, 1.06 * sum_best);
  EXPECT_GT(sum_nearest, 1.12 * sum_best);
}

}  // namespace
}  // namespace rlpc
