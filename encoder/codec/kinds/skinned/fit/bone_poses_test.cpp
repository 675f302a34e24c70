#include "encoder/codec/kinds/skinned/fit/bone_poses.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "encoder/testing/random_points.h"
#include "encoder/testing/rigid.h"

namespace rlpc {
namespace {

using Weights = std::vector<RigWeight>;

Motion identity_motion() {
  Motion m = Motion::Zero();
  m.leftCols<3>().setIdentity();
  return m;
}

// A skinned mesh in one frame, and the sums under test.
struct Skin {
  std::vector<Vec3d> rest;
  std::vector<Weights> weights;
  std::vector<Vec3d> wanted;

  void add(const Vec3d& p, Weights w) {
    rest.push_back(p);
    weights.push_back(std::move(w));
  }
  Vec3d blend(std::size_t v, const std::vector<Motion>& motions) const {
    Vec3d sum = Vec3d::Zero();
    for (const RigWeight& w : weights[v]) sum += w.weight * moved(motions[w.bone], rest[v]);
    return sum;
  }
  void move_as(const std::vector<Motion>& motions) {
    wanted.clear();
    for (std::size_t v = 0; v < rest.size(); ++v) wanted.push_back(blend(v, motions));
  }
  double error(const std::vector<Motion>& motions) const {
    double sum = 0.0;
    for (std::size_t v = 0; v < rest.size(); ++v) {
      sum += (wanted[v] - blend(v, motions)).squaredNorm();
    }
    return sum;
  }
  SkinMoments moments(std::size_t num_bones) const {
    SkinMoments result(num_bones);
    for (std::size_t v = 0; v < rest.size(); ++v) result.add(rest[v], weights[v]);
    return result;
  }
  std::vector<Motion> targets(std::size_t num_bones) const {
    PoseTargets result(num_bones, 1);
    for (std::size_t v = 0; v < rest.size(); ++v)
      result.add(rest[v], weights[v], {&wanted[v], 1});
    return result.frame_motions(0);
  }
  void refine(std::vector<Motion>& motions) const {
    refine_poses(moments(motions.size()), targets(motions.size()), motions);
  }
  void solve(std::vector<Motion>& motions) const {
    solve_poses(moments(motions.size()), targets(motions.size()), motions);
  }
};

// A beam along x that bends between consecutive bones.
Skin beam(std::size_t num_bones, RandomPoints& random) {
  Skin skin;
  for (int v = 0; v < 60; ++v) {
    const double place = v / 60.0 * static_cast<double>(num_bones);
    const auto bone = static_cast<std::uint32_t>(place);
    const double next = place - bone;
    const Vec3d p = Vec3d(place, 0, 0) + random.point();
    if (bone + 1 < num_bones) {
      skin.add(p, {{bone, 1.0 - next}, {bone + 1, next}});
    } else {
      skin.add(p, {{bone, 1.0}});
    }
  }
  return skin;
}

double distance_of_motions(const std::vector<Motion>& a, const std::vector<Motion>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum);
}

TEST(SkinMoments, AreSumsOverPairsOfBones) {
  SkinMoments moments(3);
  moments.add({1, 2, 3}, Weights{{0, 0.5}, {1, 0.25}});
  moments.add({3, 0, 1}, Weights{{0, 1.0}});
  Eigen::Matrix4d both;
  both << 1, 2, 3, 1, 2, 4, 6, 2, 3, 6, 9, 3, 1, 2, 3, 1;
  Eigen::Matrix4d alone;
  alone << 9, 0, 3, 3, 0, 0, 0, 0, 3, 0, 1, 1, 3, 0, 1, 1;
  EXPECT_EQ(moments.block(0, 0), 0.25 * both + alone);
  EXPECT_EQ(moments.block(0, 1), 0.125 * both);
  EXPECT_EQ(moments.block(1, 0), 0.125 * both);
  EXPECT_EQ(moments.block(1, 1), 0.0625 * both);
  EXPECT_EQ(moments.mass(0), 1.25);
  EXPECT_EQ(moments.centre(1), Vec3d(1, 2, 3));
  EXPECT_LT((moments.centre(0) - Vec3d(2.6, 0.4, 1.4)).norm(), 1e-15);
  EXPECT_NEAR(moments.spread2(0), 0.16 * 12.0,
              1e-12);  // variance of the weights, 0.2 * 0.8, times the squared distance, 12
  EXPECT_EQ(moments.spread2(1), 0.0);
  EXPECT_EQ(moments.mass(2), 0.0);  // a bone without vertices
  EXPECT_EQ(moments.centre(2), Vec3d(0, 0, 0));
  EXPECT_EQ(moments.spread2(2), 0.0);
}

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
    EXPECT_EQ(targets.frame_motions(f), expected) << f;
  }
}

// A bone without vertices keeps its motion.
TEST(RefinePoses, MovesBonesToTheirVertices) {
  Skin skin;
  for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)}) {
    skin.add(p, {{0, 1.0}});
  }
  Motion turn;  // a quarter turn about z, and a translation
  turn << 0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7;
  skin.move_as({turn, identity_motion()});
  std::vector<Motion> motions(2, identity_motion());
  skin.refine(motions);
  EXPECT_LT((motions[0] - turn).norm(), 1e-9);
  EXPECT_EQ(motions[1], identity_motion());
}

// Holds for random targets and at any distance from the solution.
TEST(RefinePoses, NeverRaisesTheError) {
  RandomPoints random(1);
  for (int i = 0; i < 30; ++i) {
    Skin skin = beam(4, random);
    for (const Vec3d& p : skin.rest) skin.wanted.push_back(p + 3.0 * random.point());
    std::vector<Motion> motions(4, random.motion(2.0));
    for (int sweep = 0; sweep < 4; ++sweep) {
      const double before = skin.error(motions);
      skin.refine(motions);
      expect_rigid(motions);
      EXPECT_LE(skin.error(motions), before * (1.0 + 1e-12));
    }
    // The motion of the last bone is optimal given the others.
    const double min = skin.error(motions);
    for (int k = 0; k < 20; ++k) {
      const Motion nudge = random.motion(0.01);
      std::vector<Motion> other = motions;
      other[3].leftCols<3>() = nudge.leftCols<3>() * motions[3].leftCols<3>();
      other[3].col(3) += nudge.col(3);
      EXPECT_GE(skin.error(other), min * (1.0 - 1e-9));
    }
  }
}

// Computes the Gauss-Newton step from the vertices, with derivatives by finite differences. The
// parameters of a bone are a rotation vector, applied after R, and the translation.
std::vector<Motion> step_by_differences(const Skin& skin, const std::vector<Motion>& motions) {
  constexpr double kDelta = 1e-6;
  const auto n = static_cast<Eigen::Index>(motions.size());
  const auto rows = static_cast<Eigen::Index>(3 * skin.rest.size());
  const auto turned = [](const Motion& m, const Eigen::Matrix<double, 6, 1>& x) {
    Motion result = m;
    result.leftCols<3>() =
        rotation_matrix(normalised({1.0, 0.5 * x(0), 0.5 * x(1), 0.5 * x(2)})) *
        m.leftCols<3>();
    result.col(3) += x.tail<3>();
    return result;
  };
  Eigen::MatrixXd jacobian(rows, 6 * n);
  Eigen::VectorXd left(rows);
  for (std::size_t v = 0; v < skin.rest.size(); ++v) {
    const auto row = static_cast<Eigen::Index>(3 * v);
    left.segment<3>(row) = skin.wanted[v] - skin.blend(v, motions);
    for (Eigen::Index k = 0; k < 6 * n; ++k) {
      std::vector<Motion> up = motions;
      std::vector<Motion> down = motions;
      const auto bone = static_cast<std::size_t>(k / 6);
      const Eigen::Matrix<double, 6, 1> x = kDelta * Eigen::Matrix<double, 6, 1>::Unit(k % 6);
      up[bone] = turned(motions[bone], x);
      down[bone] = turned(motions[bone], -x);
      jacobian.block<3, 1>(row, k) = (skin.blend(v, up) - skin.blend(v, down)) / (2.0 * kDelta);
    }
  }
  const Eigen::VectorXd x = jacobian.colPivHouseholderQr().solve(left);
  std::vector<Motion> result;
  for (Eigen::Index b = 0; b < n; ++b) {
    result.push_back(turned(motions[static_cast<std::size_t>(b)], x.segment<6>(6 * b)));
  }
  return result;
}

// The two agree up to damping.
TEST(SolvePoses, IsAGaussNewtonStep) {
  RandomPoints random(2);
  for (int i = 0; i < 20; ++i) {
    Skin skin = beam(3, random);
    for (const Vec3d& p : skin.rest) skin.wanted.push_back(p + 0.1 * random.point());
    std::vector<Motion> motions;
    motions.reserve(3);
    for (int b = 0; b < 3; ++b) motions.push_back(random.motion(0.2));
    const std::vector<Motion> expected = step_by_differences(skin, motions);
    const double length = distance_of_motions(expected, motions);
    skin.solve(motions);
    expect_rigid(motions);
    EXPECT_LT(distance_of_motions(motions, expected), 0.02 * length) << i;
  }
}

// Vertices follow several bones; the start is as close as callers guarantee.
TEST(SolvePoses, FindsTheMotionsOfBlendedBones) {
  RandomPoints random(3);
  for (const std::size_t num_bones : {1U, 2U, 5U}) {
    Skin skin = beam(num_bones, random);
    std::vector<Motion> truth;
    std::vector<Motion> motions;
    for (std::size_t b = 0; b < num_bones; ++b) {
      truth.push_back(random.motion(1.0));
      const Motion nudge = random.motion(0.1);
      motions.push_back(truth.back());
      motions.back().leftCols<3>() = nudge.leftCols<3>() * truth.back().leftCols<3>();
      motions.back().col(3) += nudge.col(3);
    }
    skin.move_as(truth);
    for (int step = 0; step < 8; ++step) {
      const double before = skin.error(motions);
      skin.solve(motions);
      expect_rigid(motions);
      EXPECT_LT(skin.error(motions), 0.1 * before + 1e-20) << num_bones << ' ' << step;
    }
    EXPECT_LT(distance_of_motions(motions, truth), 1e-6) << num_bones;
    const std::vector<Motion> there = motions;
    skin.solve(motions);
    EXPECT_LT(distance_of_motions(motions, there), 1e-6);
  }
}

// Without rotation, the step of a bone is the mean residual of its vertices.
TEST(SolvePoses, TranslatesASingleBone) {
  Skin skin;
  for (const Vec3d& p : {Vec3d(1, 0, 0), Vec3d(-1, 0, 0), Vec3d(0, 2, 0), Vec3d(0, -2, 0)}) {
    skin.add(p, {{0, 1.0}});
    skin.wanted.push_back(p + Vec3d(10, 20, -30));
  }
  std::vector<Motion> motions{identity_motion()};
  skin.solve(motions);
  expect_rigid(motions);
  EXPECT_LT((motions[0].leftCols<3>() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_LT((motions[0].col(3) - Vec3d(10, 20, -30)).norm(), 0.05);  // damped
}

// Covers ambiguous cases: rotation about the line of all vertices, or two bones with the same
// vertices.
TEST(SolvePoses, LowersTheErrorOfDegenerateBones) {
  RandomPoints random(4);
  Skin line;
  Skin point;
  Skin twins;
  Skin flat;
  for (int v = 0; v < 8; ++v) {
    line.add({0.5 * v, 0, 0}, {{0, 1.0}});
    point.add({1, 2, 3}, {{0, 1.0}});
    twins.add(random.point(), {{0, 0.5}, {1, 0.5}});
    flat.add({0.5 * (v % 3), 0.25 * v, 0}, {{0, 0.75}, {1, 0.25}});
  }
  for (Skin* skin : {&line, &point, &twins, &flat}) {
    const Motion nudge = random.motion(0.2);
    for (const Vec3d& p : skin->rest) skin->wanted.push_back(moved(nudge, p));
    // A third bone without vertices, or with weight 0 only, keeps its motion.
    skin->weights[0].push_back({2, 0.0});
    std::vector<Motion> motions(4, identity_motion());
    motions[2].col(3) = motions[3].col(3) = Vec3d(7, 8, 9);
    const std::vector<Motion> start = motions;
    const double before = skin->error(motions);
    for (int step = 0; step < 4; ++step) skin->solve(motions);
    expect_rigid(motions);
    EXPECT_LT(skin->error(motions), 0.01 * before);
    EXPECT_EQ(motions[2], start[2]);
    EXPECT_EQ(motions[3], start[3]);
  }
}

TEST(SkinMoments, KnowWhichBonesShareVertices) {
  SkinMoments moments(4);
  moments.add({1, 2, 3}, std::vector<RigWeight>{{3, 0.75}, {1, 0.25}});
  moments.add({3, 2, 1}, std::vector<RigWeight>{{1, 0.5}, {0, 0.5}});
  moments.add({0, 0, 1}, std::vector<RigWeight>{{1, 0.5}, {3, 0.5}});
  EXPECT_EQ(moments.sharing(0), (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(moments.sharing(1), (std::vector<std::size_t>{0, 1, 3}));
  EXPECT_EQ(moments.sharing(2), std::vector<std::size_t>{});
  EXPECT_EQ(moments.sharing(3), (std::vector<std::size_t>{1, 3}));
}

}  // namespace
}  // namespace rlpc
