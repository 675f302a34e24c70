#include "encoder/skinned_gof/fit/bone_poses.h"

#include <gtest/gtest.h>

#include <vector>

namespace rlpc {
namespace {

TEST(PoseTargets, AreSumsOverVerticesInEachFrame) {
  const std::vector<Vec3d> rest{{1, 2, 3}, {-4, 0, 5}};
  const std::vector<std::vector<RigWeight>> weights{{{1, 0.75}, {0, 0.25}}, {{1, 1.0}}};
  const std::vector<std::vector<Vec3d>> trajectories{{{1, 0, 2}, {3, -1, 0}, {0, 0, 8}},
                                                     {{2, 2, 2}, {0, 5, 1}, {7, 0, -3}}};
  PoseTargets targets(2, 3);
  for (std::size_t v = 0; v < rest.size(); ++v) {
    targets.add(rest[v], weights[v], trajectories[v]);
  }
  for (std::size_t f = 0; f < 3; ++f) {
    std::vector<Motion> expected(2, Motion::Zero());
    for (std::size_t v = 0; v < rest.size(); ++v) {
      const Eigen::Vector4d p{rest[v](0), rest[v](1), rest[v](2), 1.0};
      for (const RigWeight& w : weights[v]) {
        expected[w.bone] += w.weight * (trajectories[v][f] * p.transpose());
      }
    }
    EXPECT_EQ(targets.of_frame(f), expected) << f;
  }
}

// A bone without vertices stays.
TEST(RefinePoses, MovesBonesToTheirVertices) {
  const std::vector<Vec3d> rest{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Motion turn;  // a quarter about z, and a shift
  turn << 0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7;
  SkinMoments moments(2);
  PoseTargets targets(2, 1);
  for (const Vec3d& p : rest) {
    const std::vector<RigWeight> weights{{0, 1.0}};
    const Vec3d position = moved(turn, p);
    moments.add(p, weights);
    targets.add(p, weights, {&position, 1});
  }
  Motion identity = Motion::Zero();
  identity.leftCols<3>().setIdentity();
  std::vector<Motion> motions(2, identity);
  refine_poses(moments, targets.of_frame(0), motions);
  EXPECT_LT((motions[0] - turn).norm(), 1e-9);
  EXPECT_EQ(motions[1], identity);
}

}  // namespace
}  // namespace rlpc
