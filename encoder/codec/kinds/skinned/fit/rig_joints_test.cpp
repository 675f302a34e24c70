#include "encoder/codec/kinds/skinned/fit/rig_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace rlpc {
namespace {

constexpr int kRigFrames = 10;
constexpr int kMovedFrames = 2 * (kRigFrames / 2);  // of two vertices, every second frame
constexpr double kLever = 100.0;                    // distance of the vertices from the pivot

// Bone 1 turns by `angle` relative to bone 0 in every second frame, and leaves it by `gap`.
Rig two_bones(double gap, double angle) {
  Rig rig;
  rig.bones.resize(2);
  rig.bones[1].parent = 0;
  rig.bones[1].pivot = {1000.0, 0.0, 0.0};
  for (int f = 0; f < kRigFrames; ++f) {
    rig.bones[0].poses.push_back({{1.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 5.0 * f}});
    const double half = f % 2 == 0 ? 0.0 : 0.5 * angle;
    rig.bones[1].poses.push_back({{std::cos(half), 0.0, 0.0, std::sin(half)},
                                  {1000.0, f % 2 == 0 ? 0.0 : gap, 5.0 * f}});
  }
  for (const double y : {kLever, -kLever}) {
    rig.rest.push_back({1000.0, y, 0.0});
    rig.weights.push_back({{1, 1.0}});
  }
  return rig;
}

Rig fixed(double max_error, Rig rig) {
  fix_joints(max_error, rig);
  return rig;
}

// Two vertices, half of the frames.
TEST(RigJoints, ArePinnedIfThatAddsLittleError) {
  const double error = kMovedFrames * 3.0 * 3.0;
  EXPECT_TRUE(fixed(1.01 * error, two_bones(3.0, 1.0)).bones[1].pinned);
  EXPECT_FALSE(fixed(0.99 * error, two_bones(3.0, 1.0)).bones[1].pinned);
  EXPECT_TRUE(fixed(0.0, two_bones(0.0, 1.0)).bones[1].pinned);
}

TEST(RigJoints, TurnWithTheirParentsIfThatAddsLittleError) {
  constexpr double kAngle = 0.01;
  // About a random axis, two thirds of the squared lever count.
  const double error = kMovedFrames * kAngle * kAngle * kLever * kLever * 2.0 / 3.0;
  EXPECT_FALSE(fixed(1.01 * error, two_bones(9.0, kAngle)).bones[1].rotates);
  EXPECT_TRUE(fixed(0.99 * error, two_bones(9.0, kAngle)).bones[1].rotates);
}

TEST(RigJoints, CountWhatFollowsFromBelow) {
  Rig rig = two_bones(3.0, 1.0);
  rig.bones.push_back(rig.bones[1]);
  rig.bones[2].parent = 1;
  for (auto& weights : rig.weights) weights[0].bone = 2;
  const double error = kMovedFrames * 3.0 * 3.0;
  EXPECT_FALSE(fixed(0.99 * error, rig).bones[1].pinned);
  EXPECT_TRUE(fixed(0.99 * error, rig).bones[2].pinned);
  EXPECT_FALSE(fixed(0.99 * error, rig).bones[2].rotates);
}

}  // namespace
}  // namespace rlpc
