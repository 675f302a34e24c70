#include "encoder/codec/kinds/skinned/reuse/pose_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/bone_stretch.h"
#include "encoder/codec/kinds/skinned/quantise/mean_motion.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kVertices = 60;

// Two bones along x that meet in the middle, where vertices follow both.
struct Arm {
  Arm() {
    rig.weight_bits = 6;
    rig.bones.resize(2);
    for (Bone& bone : rig.bones) bone.rotation_flag = bone.origin_flag = true;
    rig.bones[1].parent = 0;
    rig.bones[1].pivot = {16 * 3000, 0, 0};
    for (std::uint32_t v = 0; v < kVertices; ++v) {
      const std::array<double, 3> p{100.0 * v, 500.0 * std::sin(1.1 * v),
                                    400.0 * std::cos(2.3 * v)};
      for (std::size_t c = 0; c < 3; ++c) {
        rest[c].push_back(static_cast<std::int32_t>(std::lround(16.0 * p[c])));
      }
      Influences& of = rig.influences.emplace_back();
      const int second = v < 25 ? 0 : v < 35 ? 6 * static_cast<int>(v - 24) - 2 : 64;
      if (second < 64) of.list[of.size++] = {0, static_cast<std::uint16_t>(64 - second)};
      if (second > 0) of.list[of.size++] = {1, static_cast<std::uint16_t>(second)};
    }
  }

  // gap: gap of the joint along y.
  std::vector<std::vector<WantedPose>> poses(std::uint32_t num_frames, double gap) const {
    std::vector<std::vector<WantedPose>> list(2);
    for (std::uint32_t f = 0; f < num_frames; ++f) {
      const double half = 0.3 * std::sin(0.5 * f);
      const double bend = half + 0.4 * std::cos(0.8 * f);
      const bool turns = rig.bones[0].rotation_flag;
      const double first = turns ? half : 0.0;
      WantedPose root{{std::cos(first), 0.0, 0.0, std::sin(first)}, {800.0 * f, 100.0, 0.0}};
      const double c = std::cos(2.0 * first);
      const double s = std::sin(2.0 * first);
      WantedPose child{{std::cos(bend), 0.0, 0.0, std::sin(bend)},
                       {root.origin[0] + c * 48000.0, root.origin[1] + s * 48000.0 + gap, 0.0}};
      list[0].push_back(root);
      list[1].push_back(child);
    }
    return list;
  }

  SpanFrames moved(const std::vector<std::vector<WantedPose>>& poses,
                   const std::vector<std::vector<AxisImages>>& axes = {{}, {}}) const {
    SpanFrames frames{kVertices, static_cast<std::uint32_t>(poses[0].size()), {}, 0, 1, false};
    MotionsOfBones motions;
    for (std::size_t b = 0; b < 2; ++b) {
      motions.push_back(motions_of(rig.bones[b].pivot, poses[b], axes[b]));
    }
    frames.xyz.resize(std::size_t{3} * kVertices * frames.num_frames);
    MeanMotions means(motions);
    for (std::uint32_t v = 0; v < kVertices; ++v) {
      const auto mean = means.of(rig.influences[v], rig.weight_bits);
      for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
          double x = mean[f].shift[c];
          for (std::size_t k = 0; k < 3; ++k) x += mean[f].turn[k][c] * rest[k][v] / 16.0;
          frames.xyz[(std::size_t{f} * kVertices + v) * 3 + c] = x;
        }
      }
    }
    return frames;
  }

  SharedRig rig;
  std::array<std::vector<std::int32_t>, 3> rest;
};

std::vector<std::vector<WantedPose>> fitted(const Arm& arm, const SpanFrames& frames) {
  std::vector<std::vector<WantedPose>> poses;
  for (FittedPoses& bone :
       PoseFit(arm.rig, arm.rest).fit(frames, numbers_from(0, frames.num_frames))) {
    EXPECT_TRUE(bone.axes.empty());
    poses.push_back(std::move(bone.poses));
  }
  return poses;
}

void expect_near(const std::vector<std::vector<WantedPose>>& found,
                 const std::vector<std::vector<WantedPose>>& wanted, double tolerance) {
  for (std::size_t b = 0; b < wanted.size(); ++b) {
    ASSERT_EQ(found[b].size(), wanted[b].size());
    for (std::size_t f = 0; f < wanted[b].size(); ++f) {
      double same = 0.0;
      for (std::size_t k = 0; k < 4; ++k)
        same += found[b][f].rotation[k] * wanted[b][f].rotation[k];
      EXPECT_NEAR(std::abs(same), 1.0, 1e-4) << b << ' ' << f;
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[b][f].origin[c], wanted[b][f].origin[c], tolerance) << b << ' ' << f;
      }
    }
  }
}

TEST(PoseFit, FindsThePosesOfAllBones) {
  const Arm arm;
  const auto wanted = arm.poses(20, 700.0);
  const SpanFrames frames = arm.moved(wanted);
  const PoseFit fit(arm.rig, arm.rest);
  expect_near(fitted(arm, frames), wanted, 16.0);
  // A single frame starts from scratch.
  const std::uint32_t last = 19;
  EXPECT_NEAR(fit.fit(frames, std::span(&last, 1))[1].poses[0].origin[0],
              wanted[1][19].origin[0], 16.0);
}

// The root shrinks along x, and the child with it; vertices between them follow both.
TEST(PoseFit, FindsStretches) {
  Arm arm;
  arm.rig.stretch_flag = true;
  arm.rig.bones[0].stretch = Stretch::kRestAxes;
  const auto poses = arm.poses(20, 700.0);
  std::vector<std::vector<AxisImages>> wanted(2);
  for (std::uint32_t f = 0; f < 20; ++f) {
    const double factor = 0.8 + 0.2 * std::cos(0.4 * f);
    for (std::size_t b = 0; b < 2; ++b) {
      Eigen::Matrix3d axes = rotation_matrix(poses[b][f].rotation);
      axes.col(0) *= factor;
      wanted[b].push_back(images_of(axes));
    }
  }
  const SpanFrames frames = arm.moved(poses, wanted);
  const auto found = PoseFit(arm.rig, arm.rest).fit(frames, numbers_from(0, 20));
  for (std::size_t b = 0; b < 2; ++b) {
    ASSERT_EQ(found[b].axes.size(), 20U);
    for (std::size_t f = 0; f < 20; ++f) {
      const double gap = (matrix_of(found[b].axes[f]) - matrix_of(wanted[b][f])).norm();
      EXPECT_LT(gap, 1e-3) << b << ' ' << f;
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[b].poses[f].origin[c], poses[b][f].origin[c], 16.0) << b << ' ' << f;
      }
    }
  }
}

TEST(PoseFit, QuaternionsKeepTheirSign) {
  const Arm arm;
  const SpanFrames frames = arm.moved(arm.poses(20, 0.0));
  for (const auto& bone_motions : fitted(arm, frames)) {
    for (std::size_t f = 1; f < bone_motions.size(); ++f) {
      double same = 0.0;
      for (std::size_t k = 0; k < 4; ++k) {
        same += bone_motions[f].rotation[k] * bone_motions[f - 1].rotation[k];
      }
      EXPECT_GT(same, 0.5) << f;
    }
  }
}

TEST(PoseFit, PinnedBonesKeepTheirJoint) {
  Arm arm;
  arm.rig.bones[1].origin_flag = false;
  const auto wanted = arm.poses(20, 0.0);
  expect_near(fitted(arm, arm.moved(wanted)), wanted, 16.0);
  // Where the joint opens, the child still begins where the parent ends.
  const SpanFrames open = arm.moved(arm.poses(20, 900.0));
  const auto found = fitted(arm, open);
  const auto motions = motions_of(arm.rig.bones[0].pivot, found[0]);
  for (std::size_t f = 0; f < 20; ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double carried = motions[f].shift[c] + motions[f].turn[0][c] * 3000.0;
      EXPECT_NEAR(found[1][f].origin[c], 16.0 * carried, 1e-3) << f;
    }
  }
}

TEST(PoseFit, BonesThatDoNotRotateMoveAlong) {
  Arm arm;
  arm.rig.bones[0].rotation_flag = false;
  const auto wanted = arm.poses(20, 0.0);
  const auto found = fitted(arm, arm.moved(wanted));
  expect_near(found, wanted, 16.0);
  for (const WantedPose& pose : found[0]) EXPECT_NEAR(pose.rotation[0], 1.0, 1e-12);
}

}  // namespace
}  // namespace rlpc
