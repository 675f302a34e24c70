#include "common/codec/kinds/cluster/recon/seed_tracks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "common/testing/residual_bound.h"

namespace rlpc {
namespace {

ClusterGof tracks_of(std::vector<SeedTrack> tracks, std::uint32_t num_frames) {
  ClusterGof gof;
  gof.num_frames = num_frames;
  gof.seed_tracks = std::move(tracks);
  for (SeedTrack& track : gof.seed_tracks) track.residual.resize(num_frames);
  return gof;
}

TEST(SeedTracks, AreTheScaledResidualsWithoutPredictor) {
  ClusterGof gof = tracks_of({{4, 0, {{1, -2, 3}, {5, 0, -7}}}}, 2);
  gof.seed_predictor = 0;
  gof.seed_step = 10;
  const std::vector<Track> tracks = recon_seed_tracks(gof, 20);
  ASSERT_EQ(tracks.size(), 1U);
  EXPECT_EQ(tracks[0], (Track{{10, -20, 30}, {50, 0, -70}}));
}

// In frame 0, anchors are predicted from the previous track, and other tracks from their
// anchor.
TEST(SeedTracks, FirstFrameIsPredictedFromOtherTracks) {
  const ClusterGof gof = tracks_of({{0, 0, {{100, 0, 0}}},
                                    {1, 0, {{1, 1, 1}}},
                                    {2, 0, {{2, 2, 2}}},
                                    {3, 3, {{0, 50, 0}}},
                                    {4, 3, {{0, 0, 1}}},
                                    {5, 1, {{7, 0, 0}}}},
                                   1);
  const std::vector<Track> tracks = recon_seed_tracks(gof, 20);
  EXPECT_EQ(tracks[0][0], (Vec3i{100, 0, 0}));
  EXPECT_EQ(tracks[1][0], (Vec3i{101, 1, 1}));
  EXPECT_EQ(tracks[2][0], (Vec3i{102, 2, 2}));
  EXPECT_EQ(tracks[3][0], (Vec3i{102, 52, 2}));  // from track 2
  EXPECT_EQ(tracks[4][0], (Vec3i{102, 52, 3}));  // from track 3
  EXPECT_EQ(tracks[5][0], (Vec3i{108, 1, 1}));   // from track 1
}

TEST(SeedTracks, FollowPolynomialsWithoutResidualsAfterTheFirstFrames) {
  for (int order = 1; order <= kMaxPredictorOrder; ++order) {
    std::vector<Vec3i> residual(12);
    // Residuals of the polynomial f^(order - 1) under predictors of growing order.
    const auto value = [&](int f) {
      int power = 1;
      for (int k = 1; k < order; ++k) power *= f;
      return power;
    };
    std::vector<std::int64_t> values;
    for (int f = 0; f < order; ++f) {
      const std::int64_t prediction = predict_series([&](std::uint32_t g) { return values[g]; },
                                                     static_cast<std::uint32_t>(f), order);
      values.push_back(value(f));
      residual[static_cast<std::size_t>(f)][1] =
          static_cast<std::int32_t>(value(f) - prediction);
    }
    ClusterGof gof = tracks_of({{0, 0, residual}}, 12);
    gof.seed_predictor = order;
    const std::vector<Track> tracks = recon_seed_tracks(gof, 24);
    for (int f = 0; f < 12; ++f) {
      EXPECT_EQ(tracks[0][static_cast<std::size_t>(f)], (Vec3i{0, value(f), 0})) << order;
    }
  }
}

// With coupling, the prediction of a track includes the prediction residual of its anchor.
TEST(SeedTracks, CoupledTracksFollowTheirAnchor) {
  const std::vector<Vec3i> jumps{{5, 0, 0}, {100, -40, 3}, {-7, 0, 0}, {0, 0, 90}};
  ClusterGof gof = tracks_of({{0, 0, jumps}, {1, 0, {{11, 22, 33}}}}, 4);
  gof.seed_coupling_flag = true;
  for (int order = 0; order <= kMaxPredictorOrder; ++order) {
    gof.seed_predictor = order;
    const std::vector<Track> tracks = recon_seed_tracks(gof, 24);
    for (std::size_t f = 0; f < 4; ++f) {
      // Order 0 predicts zero, so the offset of frame 0 is not carried on.
      const Vec3i offset = order == 0 && f > 0 ? Vec3i{0, 0, 0} : Vec3i{11, 22, 33};
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(tracks[1][f][c], tracks[0][f][c] + offset[c]) << order << " " << f;
      }
    }
  }
  gof.seed_coupling_flag = false;
  gof.seed_predictor = 1;
  const std::vector<Track> apart = recon_seed_tracks(gof, 24);
  for (std::size_t f = 0; f < 4; ++f) EXPECT_EQ(apart[1][f], (Vec3i{16, 22, 33}));
}

// Saturating inputs. The reference computes each step in double precision, which is exact here,
// and clips.
TEST(SeedTracks, AreClippedToPositionBitsWhateverTheResiduals) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const int position_bits = 2 + static_cast<int>(random() % 23);
    constexpr std::uint32_t kFrames = 9;
    std::vector<SeedTrack> list(6);
    for (std::uint32_t i = 0; i < list.size(); ++i) {
      list[i].vertex = i;
      list[i].anchor = i < 3 ? 0 : i;
      list[i].residual.resize(kFrames);
      for (Vec3i& r : list[i].residual) {
        for (std::int32_t& c : r) {
          const auto kind = random() % 4;
          c = kind == 0   ? kResidualBound
              : kind == 1 ? -kResidualBound
                          : static_cast<std::int32_t>(random() % 2001) - 1000;
        }
      }
    }
    ClusterGof gof = tracks_of(list, kFrames);
    gof.seed_step = seed % 3 == 0 ? kMaxSeedStep : 1 + static_cast<std::uint32_t>(random() % 9);
    gof.seed_predictor = static_cast<int>(seed % 5);
    gof.seed_coupling_flag = seed % 2 == 0;
    const std::vector<Track> tracks = recon_seed_tracks(gof, position_bits);
    const double half = static_cast<double>(1 << (position_bits - 1));
    for (std::size_t i = 0; i < list.size(); ++i) {
      for (std::uint32_t f = 0; f < kFrames; ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
          const double wanted =
              static_cast<double>(predict_seed(gof, tracks, i, f, c)) +
              static_cast<double>(gof.seed_step) * gof.seed_tracks[i].residual[f][c];
          ASSERT_EQ(tracks[i][f][c], std::clamp(wanted, -half, half - 1));
        }
      }
    }
  }
}

}  // namespace
}  // namespace rlpc
