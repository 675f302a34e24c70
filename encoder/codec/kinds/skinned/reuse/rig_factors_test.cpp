#include "encoder/codec/kinds/skinned/reuse/rig_factors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "encoder/codec/kinds/skinned/quantise/skinned_gof_encoder.h"
#include "encoder/codec/kinds/skinned/quantise/span_tracks.h"
#include "encoder/testing/kept_tube.h"

namespace rlpc {
namespace {

// Returns displacements that the factors make with these temporal values, and something else.
TrajectoryRows product(const RigFactors& factors, const std::vector<double>& temporal,
                       std::size_t width, double other) {
  return {KeptTube::kVertices, width,
          [&factors, &temporal, width, other](std::size_t first, std::span<double> rows) {
            const std::size_t n = factors.count();
            const std::vector<double> of = factors.of(first, rows.size() / width);
            for (std::size_t i = 0; i < rows.size(); ++i) {
              const std::size_t v = i / width;
              rows[i] = other * std::sin(static_cast<double>(first + v));
              for (std::size_t l = 0; l < n; ++l) {
                rows[i] += of[v * n + l] * temporal[l * width + i % width];
              }
            }
          }};
}

TEST(RigFactors, FitsTheTemporalValues) {
  const KeptTube tube;
  const RigFactors factors(*tube.kept);
  ASSERT_GT(factors.count(), 2U);
  constexpr std::size_t kWidth = 6;
  std::vector<double> temporal(factors.count() * kWidth);
  for (std::size_t i = 0; i < temporal.size(); ++i) {
    temporal[i] = 10.0 * std::sin(1.3 * static_cast<double>(i));
  }
  const std::vector<double> exact = factors.fit(product(factors, temporal, kWidth, 0.0));
  for (std::size_t i = 0; i < temporal.size(); ++i) EXPECT_NEAR(exact[i], temporal[i], 1e-6);
  // The residual is orthogonal to the factors.
  const std::vector<double> fitted = factors.fit(product(factors, temporal, kWidth, 50.0));
  std::vector<double> left;
  for (std::size_t i = 0; i < fitted.size(); ++i) left.push_back(temporal[i] - fitted[i]);
  for (const double x : factors.fit(product(factors, left, kWidth, 50.0))) {
    EXPECT_NEAR(x, 0.0, 1e-6);
  }
}

// A temporal value of a unit moves a vertex by its factor, as a decoder sees it.
TEST(RigFactors, AreThoseOfTheDecoder) {
  const KeptTube tube;
  const SharedRig& rig = *tube.kept->rig;
  const RigFactors factors(*tube.kept);
  SkinnedGof gof;
  gof.num_frames = 1;
  gof.bones = rig.bones;
  for (Bone& bone : gof.bones) {
    bone.rotation_residual.resize(1);
    bone.origin_residual.resize(1);
  }
  gof.trajectories = rig.trajectories;
  for (Trajectory& t : gof.trajectories) t.trajectory_flag = false;
  use_rig(tube.kept->rig, gof);
  std::vector<std::int32_t> still(3 * KeptTube::kVertices);
  SkinnedRecon(tube.kept->recon, gof).frame(0, still);
  for (std::size_t l = 0; l < factors.count(); ++l) {
    Trajectory& t = gof.trajectories[l];
    const Trajectory left_out = t;
    t.trajectory_flag = true;
    t.residual = {{3, 0, 0}};
    const int shift = spatial_factor_bits(t.spatial_bits) - t.spatial_bits;
    ASSERT_TRUE(set_scale(8 * (4 - shift + rig.fraction_bits) + 16, t.residual, t)) << l;
    std::vector<std::int32_t> moved(still.size());
    SkinnedRecon(tube.kept->recon, gof).frame(0, moved);
    const std::vector<double> of = factors.of(0, KeptTube::kVertices);
    for (std::size_t v = 0; v < KeptTube::kVertices; ++v) {
      EXPECT_NEAR(moved[3 * v] - still[3 * v], 3.0 * 4.0 * of[v * factors.count() + l], 1.01);
    }
    t = left_out;
  }
}

}  // namespace
}  // namespace rlpc
