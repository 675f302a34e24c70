#include "encoder/codec/kinds/skinned/recover/bone_rotations.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/trajectories.h"
#include "encoder/testing/skinned_limb.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kAllFrames = 1000;
constexpr double kExact = 3e-6;  // ten times what rounding to floats leads to here

BoneRotations rotations_of(const SpanFrames& frames, const std::vector<Triangle>& triangles) {
  const Trajectories trajectories(frames, kAllFrames);
  return find_bone_rotations(trajectories, vertex_rings(frames.num_vertices, triangles));
}

// Returns the RMS difference between the elements of a found rotation and of the true one of a
// bone, relative to the first frame.
double difference(const SkinnedLimb& limb, std::size_t bone, const Rotations& found) {
  const std::vector<Motion>& motion = limb.motions[bone];
  const Eigen::Matrix3d first = motion[0].leftCols<3>().transpose();
  double sum = 0.0;
  for (std::size_t f = 0; f < motion.size(); ++f) {
    sum += (motion[f].leftCols<3>() * first - found[f]).squaredNorm();
  }
  return std::sqrt(sum / (9.0 * static_cast<double>(motion.size())));
}

void expect_true_rotations(const SkinnedLimb& limb) {
  const BoneRotations found = rotations_of(limb.frames, limb.triangles);
  EXPECT_EQ(found.bones.size(), limb.bones.size());
  EXPECT_GT(found.explained, 0.99);
  EXPECT_LE(found.explained, 1.0);
  for (std::size_t b = 0; b < limb.bones.size(); ++b) {
    int times = 0;
    for (const BoneRotation& bone : found.bones) {
      ASSERT_EQ(bone.rotation.size(), limb.frames.num_frames);
      ASSERT_EQ(bone.combination.size(), bone.vertices.size());
      if (difference(limb, b, bone.rotation) < kExact) ++times;
    }
    EXPECT_EQ(times, 1) << "bone " << b;
  }
}

TEST(BoneRotations, FindsEachBoneOfALimbOnce) {
  expect_true_rotations(SkinnedLimb(limb_chain(std::array{1.0, 1.0, 1.0}), {}));
  expect_true_rotations(SkinnedLimb(limb_chain(std::array{1.0, 0.8, 0.9, 1.0}),
                                    {.seed = 2, .num_frames = 80, .sides = 8}));
}

TEST(BoneRotations, FindsBonesWithoutVerticesOfTheirOwn) {
  expect_true_rotations(SkinnedLimb(limb_chain(std::array{1.0, 0.3, 1.0}), {.seed = 3}));
}

TEST(BoneRotations, FindsBonesThatBranch) {
  std::vector<LimbBone> bones = limb_chain(std::array{1.0, 1.0, 1.0});
  bones.push_back({.parent = 0, .along = {0.0, 1.0, 0.0}});
  bones.push_back({.parent = 3, .along = {0.0, 0.8, 0.2}});
  expect_true_rotations(SkinnedLimb(bones, {.seed = 4}));
}

TEST(BoneRotations, TurnFromTheFirstFrame) {
  const SkinnedLimb limb(limb_chain(std::array{1.0, 1.0}), {.seed = 5});
  const BoneRotations found = rotations_of(limb.frames, limb.triangles);
  ASSERT_EQ(found.bones.size(), 2U);
  for (const BoneRotation& bone : found.bones) {
    EXPECT_LT((bone.rotation[0] - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    for (const Eigen::Matrix3d& r : bone.rotation) {
      EXPECT_LT((r.transpose() * r - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    }
  }
}

// The combination gives the rotation in frames that the search did not see.
TEST(BoneRotations, AreCombinedFromPositions) {
  const SkinnedLimb limb(limb_chain(std::array{1.0, 0.3, 1.0}), {.seed = 6, .num_frames = 99});
  const Trajectories all(limb.frames, kAllFrames);
  const Trajectories some(limb.frames, 60);
  const BoneRotations found =
      find_bone_rotations(some, vertex_rings(limb.frames.num_vertices, limb.triangles));
  ASSERT_EQ(found.bones.size(), 3U);
  for (const BoneRotation& bone : found.bones) {
    Rotations combined;
    for (std::size_t f = 0; f < all.num_frames(); ++f) {
      Vec3d mean = Vec3d::Zero();
      for (const std::uint32_t v : bone.vertices) mean += all.position(f, v);
      mean /= static_cast<double>(bone.vertices.size());
      Eigen::Matrix3d& sum = combined.emplace_back(Eigen::Matrix3d::Zero());
      for (std::size_t i = 0; i < bone.vertices.size(); ++i) {
        sum += (all.position(f, bone.vertices[i]) - mean) * bone.combination[i].transpose();
      }
      sum *= all.extent() / some.extent();  // the combination is of positions in these extents
    }
    double best = 1.0;
    for (std::size_t b = 0; b < 3; ++b) best = std::min(best, difference(limb, b, combined));
    EXPECT_LT(best, 1e-4);
  }
}

TEST(BoneRotations, AreNotFoundInRandomMotion) {
  const SkinnedLimb limb(limb_chain(std::array{1.0, 1.0, 1.0}), {});
  LimbRandom noise(7);
  const SpanFrames frames = cached_frames(
      limb.frames.num_vertices, 60,
      [&](std::uint32_t, std::uint32_t v) { return Vec3d(limb.rest[v] + noise.vector(0.3)); });
  const BoneRotations found = rotations_of(frames, limb.triangles);
  EXPECT_TRUE(found.bones.empty());
  EXPECT_EQ(found.explained, 0.0);
}

TEST(BoneRotations, AreNotFoundInNoisyPositions) {
  const SkinnedLimb limb(limb_chain(std::array{1.0, 1.0, 1.0}), {});
  LimbRandom noise(8);
  const SpanFrames frames =
      cached_frames(limb.frames.num_vertices, 60, [&](std::uint32_t f, std::uint32_t v) {
        return Vec3d(limb.position(f, v) + noise.vector(1e-3));
      });
  EXPECT_TRUE(rotations_of(frames, limb.triangles).bones.empty());
}

}  // namespace
}  // namespace rlpc
