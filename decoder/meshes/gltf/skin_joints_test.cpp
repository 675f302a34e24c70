#include "decoder/meshes/gltf/skin_joints.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace rlpc {
namespace {

std::vector<std::uint32_t> keys_of_line(const std::vector<double>& values, double tolerance) {
  return needed_keys(static_cast<std::uint32_t>(values.size()),
                     [&](std::uint32_t a, std::uint32_t b) {
                       for (std::uint32_t f = a + 1; f < b; ++f) {
                         const double t = static_cast<double>(f - a) / (b - a);
                         const double x = values[a] + t * (values[b] - values[a]);
                         if (std::abs(x - values[f]) > tolerance) return false;
                       }
                       return true;
                     });
}

TEST(NeededKeys, AreTheCornersOfALine) {
  EXPECT_EQ(keys_of_line({1}, 0), (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(keys_of_line({1, 2}, 0), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(keys_of_line({0, 1, 2, 3, 2, 1, 0}, 1e-9), (std::vector<std::uint32_t>{0, 3, 6}));
  EXPECT_EQ(keys_of_line({0, 1, 2.4, 3}, 0.5), (std::vector<std::uint32_t>{0, 3}));
  EXPECT_EQ(keys_of_line({0, 1, 2.4, 3}, 0.1), (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST(KeysToWrite, AreAllFramesWhereTheseAreSmaller) {
  const auto keys = [](std::size_t count, std::uint32_t num_frames) {
    return keys_to_write(std::vector<std::uint32_t>(count), num_frames, 8).size();
  };
  EXPECT_EQ(keys(1, 2), 1U);
  EXPECT_EQ(keys(2, 3), 2U);  // many tracks have the two ends
  EXPECT_EQ(keys(90, 100), 100U);
  EXPECT_EQ(keys(50, 100), 50U);  // 12 bytes each, and JSON
  EXPECT_EQ(keys(56, 100), 100U);
}

// An arm of two bones, in units of the grid: the second one turns about the end of the first.
class Arm {
 public:
  // shrinks: the upper bone gets shorter along x, and the lower one with it.
  explicit Arm(bool shrinks = false) {
    constexpr std::int64_t kOne = std::int64_t{1} << 30;
    const std::array<Vec3l, 3> axes{{{kOne, 0, 0}, {0, kOne, 0}, {0, 0, kOne}}};
    skeleton_.bones = {{-1, {axes, {0, 0, 0}}}, {0, {axes, {160, 0, 0}}}};  // 10 units apart
    for (int f = 0; f < 40; ++f) {
      JointPlace upper{turn(0.02 * f).toRotationMatrix(), {0, 0, 1.0 * (f < 20 ? 0 : f - 20)}};
      if (shrinks) upper.axes.col(0) *= 1.0 - 0.02 * f;
      const JointPlace lower = upper.after({turn(0.05 * f).toRotationMatrix(), {10, 0, 0}});
      places_.push_back({upper, lower});
    }
  }

  JointMotion motion(double tolerance) const {
    return joint_motion(skeleton_, {}, places_, std::vector<double>{20, 10}, spans_, tolerance);
  }
  // Returns the largest distance between points moved by the maps of a motion and by the
  // places.
  double largest_error(const JointMotion& motion) const {
    double largest = 0;
    for (std::size_t i = 0; i < spans_.size(); ++i) {
      for (std::uint32_t f = 0; f < spans_[i].num_frames; ++f) {
        const JointMaps maps = joint_maps(motion, i, f);
        for (std::size_t j = 0; j < 2; ++j) {
          const Eigen::Vector3d rest(15, 2, -1);
          const JointPlace bind = joint_place(skeleton_.bones[j].bind, {});
          const Eigen::Vector3d wanted =
              places_[spans_[i].first_frame + f][j].moved(bind.inverse().moved(rest));
          largest = std::max(largest, (maps[j] * rest.homogeneous() - wanted).norm());
        }
      }
    }
    return largest;
  }

 private:
  static Eigen::Quaterniond turn(double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  }

  Skeleton skeleton_;
  std::vector<JointPlaces> places_;
  std::vector<Clip> spans_{{"a", 0, 25}, {"b", 25, 15}};
};

TEST(JointMotion, OfEvenRotationsHasKeysAtTheEnds) {
  const Arm arm;
  const JointMotion motion = arm.motion(1e-4);
  ASSERT_EQ(motion.clips.size(), 2U);
  const JointMotion::OfClip& lower = motion.clips[0][1];
  EXPECT_EQ(lower.rotation.keys, (std::vector<std::uint32_t>{0, 24}));
  EXPECT_EQ(lower.rotation.values.size(), 8U);
  EXPECT_TRUE(lower.translation.keys.empty());  // the node has it
  EXPECT_NEAR(motion.nodes[1].translation[0], 10, 1e-6);
  EXPECT_EQ(motion.nodes[1].parent, 0);
  const JointMotion::OfClip& upper = motion.clips[0][0];
  EXPECT_EQ(upper.translation.keys, (std::vector<std::uint32_t>{0, 20, 24}));
  EXPECT_LT(arm.largest_error(motion), 1e-4);
}

TEST(JointMotion, OfBonesThatStretchHasScales) {
  const Arm arm(true);
  const JointMotion motion = arm.motion(1e-4);
  const JointMotion::OfClip& upper = motion.clips[0][0];
  EXPECT_EQ(upper.scale.keys, (std::vector<std::uint32_t>{0, 24}));
  EXPECT_NEAR(upper.scale.values[3], 1.0 - 0.02 * 24, 1e-6);
  EXPECT_NEAR(upper.scale.values[4], 1.0, 1e-6);
  EXPECT_TRUE(motion.clips[0][1].scale.keys.empty());
  EXPECT_LT(arm.largest_error(motion), 2e-4);
  const Arm still;
  const JointMotion unscaled = still.motion(1e-4);
  EXPECT_TRUE(unscaled.clips[0][0].scale.keys.empty());
  EXPECT_EQ(unscaled.nodes[0].scale, (std::array<float, 3>{1.0F, 1.0F, 1.0F}));
}

TEST(TurnAndScale, RestoresTurnsAndFactors) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()));
  for (const Eigen::Vector3d& scale :
       {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0.5, 2, 1), Eigen::Vector3d(0, 1, 3)}) {
    const Eigen::Matrix3d map = turn.toRotationMatrix() * scale.asDiagonal();
    const TurnAndScale found = turn_and_scale(map, Eigen::Quaterniond::Identity());
    EXPECT_LT(found.turn.angularDistance(turn), 1e-6);
    EXPECT_LT((found.scale - scale).norm(), 1e-9);
  }
  const TurnAndScale nothing = turn_and_scale(Eigen::Matrix3d::Zero(), turn);
  EXPECT_LT(nothing.turn.angularDistance(turn), 1e-9);
  EXPECT_EQ(nothing.scale, Eigen::Vector3d::Zero());
}

TEST(JointMotion, StaysNearTheToleranceWithFewerKeys) {
  const Arm arm;
  const JointMotion coarse = arm.motion(1);
  EXPECT_EQ(coarse.clips[0][0].translation.keys.size(), 3U);
  EXPECT_EQ(arm.motion(40).clips[0][0].translation.keys.size(), 0U);
  EXPECT_LT(arm.largest_error(coarse), 4);
}

TEST(JointMotion, HasShortRotationsWhereTheseAreNearEnough) {
  const Arm arm;
  const auto lower = [](const JointMotion& motion) { return motion.clips[0][1].rotation; };
  EXPECT_FALSE(lower(arm.motion(1e-4)).has_short_values);
  const JointTrack track = lower(arm.motion(1e-2));
  EXPECT_TRUE(track.has_short_values);
  for (const float x : track.values) {
    EXPECT_NEAR(x * 32767, std::round(x * 32767), 1e-2);
  }
  EXPECT_LT(arm.largest_error(arm.motion(1e-2)), 1e-2);
}

}  // namespace
}  // namespace rlpc
