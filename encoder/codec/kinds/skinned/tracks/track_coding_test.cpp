#include "encoder/codec/kinds/skinned/tracks/track_coding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <utility>
#include <vector>

#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "encoder/codec/write/bit_cost.h"
#include "encoder/codec/write/section_writer.h"
#include "encoder/codec/write/write_track.h"

namespace rlpc {
namespace {

using Values = std::vector<std::array<double, 3>>;

constexpr std::uint32_t kFrames = 60;

Values values_of(const std::function<std::array<double, 3>(double)>& at) {
  Values values;
  for (std::uint32_t f = 0; f < kFrames; ++f) values.push_back(at(f));
  return values;
}
Values smooth() {
  return values_of([](double f) {
    return std::array<double, 3>{400.0 * std::sin(0.31 * f), 90.0 * std::cos(0.2 * f), 2.0 * f};
  });
}
// Returns deterministic noise.
Values rough() {
  return values_of([](double f) {
    return std::array<double, 3>{300.0 * std::sin(17.3 * f * f),
                                 -200.0 * std::sin(5.1 * f * f * f),
                                 std::fmod(997.0 * f, 313.0)};
  });
}

std::vector<TrackPlace> order_of(int track_levels, int between) {
  return track_order(kFrames, track_levels, between);
}

std::size_t bytes_of(const TrackResiduals& residuals,
                     const std::vector<TrackPlace>& order = order_of(0, 0)) {
  SectionWriter section;
  TrackModels models;
  std::vector<std::uint32_t> means(residuals.size(), 0);
  section.track(models, means, order, residuals);
  return section.finish().size();
}

void expect_close(const Values& values, double max, double step, const Trajectory& trajectory,
                  int track_levels) {
  const std::vector<Vec3i> decoded = recon_trajectory(trajectory, track_levels);
  ASSERT_EQ(decoded.size(), values.size());
  for (std::size_t f = 0; f < values.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_LE(std::abs(step * decoded[f][c] - values[f][c]), max * 1.000001) << f;
    }
  }
}

// Coding is closed-loop: errors do not accumulate over the frames, whatever the predictor.
TEST(CodedTrajectories, AreWithinAStep) {
  for (const Values& values : {smooth(), rough()}) {
    for (const double step : {0.01, 0.7, 3.0, 1000.0}) {
      for (const auto& [refine, nearest] :
           {std::pair(false, false), {true, false}, {true, true}}) {
        for (const int track_levels : {0, 1, 3, kMaxTrackLevels}) {
          Trajectory trajectory;
          TrackState state(kFrames);
          code_trajectory(values, step,
                          {.refine = refine, .nearest = nearest, .track_levels = track_levels},
                          state, trajectory);
          EXPECT_GE(trajectory.temporal_predictor, 0);
          EXPECT_LE(trajectory.temporal_predictor,
                    refine ? kMaxTemporalPredictor : kMaxPredictorOrder);
          expect_close(values, nearest ? 0.5 * step : step, step, trajectory, track_levels);
        }
      }
    }
  }
}

TEST(CodedTrajectories, CostLittleIfPredictable) {
  const auto bytes = [](const Values& values) {
    Trajectory trajectory;
    TrackState state(kFrames);
    code_trajectory(values, 0.5, {}, state, trajectory);
    return bytes_of(trajectory.residual);
  };
  const std::size_t still = bytes(values_of([](double) {
    return std::array<double, 3>{700.0, -8000.0, 1.0};
  }));
  const std::size_t steady = bytes(values_of([](double f) {
    return std::array<double, 3>{7.0 * f, 5.0 - 3.0 * f, 1000.0};
  }));
  const std::size_t noise_bytes = bytes(rough());
  EXPECT_LT(still, noise_bytes / 4);
  EXPECT_LT(steady, noise_bytes / 4);
  EXPECT_LT(bytes(smooth()), noise_bytes * 2 / 3);
}

TEST(CodedTrajectories, FitWeightsToAnOscillation) {
  const Values values = values_of([](double f) {
    return std::array<double, 3>{4000.0 * std::sin(1.9 * f), 3000.0 * std::cos(1.9 * f), 0.0};
  });
  Trajectory with;
  Trajectory without;
  TrackState state(kFrames);
  TrackState state_without(kFrames);
  code_trajectory(values, 1.0, {}, state, with);
  code_trajectory(values, 1.0, {.refine = false}, state_without, without);
  EXPECT_GT(with.temporal_predictor, kMaxPredictorOrder);
  EXPECT_LT(bytes_of(with.residual), bytes_of(without.residual) * 3 / 4);
}

// Some errors exceed half a step because that saves bits; the returned cost includes them.
TEST(CodedTrajectories, ReportTheirCost) {
  for (const Values& values : {smooth(), rough()}) {
    for (const double step : {0.01, 3.0, 100.0, 1000.0}) {
      Trajectory trajectory;
      TrackState state(kFrames);
      const TrackCost cost = code_trajectory(values, step, {.refine = false, .track_levels = 2},
                                             state, trajectory);
      const double written =
          8.0 * static_cast<double>(
                    bytes_of(trajectory.residual, order_of(2, trajectory.temporal_between)));
      EXPECT_NEAR(cost.bits, written, 16.0 + 0.01 * written) << step;
      const std::vector<Vec3i> decoded = recon_trajectory(trajectory, 2);
      double error = 0.0;
      for (std::size_t f = 0; f < kFrames; ++f) {
        for (std::size_t c = 0; c < 3; ++c) {
          const double steps = values[f][c] / step - decoded[f][c];
          error += steps * steps;
        }
      }
      EXPECT_NEAR(cost.error, error, 1e-6 * error) << step;
    }
  }
}

// The final state is that of a decoder that has read the residuals.
TEST(CodedTrajectories, LeaveTheStateOfTheChosenPredictor) {
  Trajectory trajectory;
  TrackState state(kFrames);
  const TrackCost cost = code_trajectory(rough(), 1.0, {.refine = false}, state, trajectory);
  TrackState again(kFrames);
  BitCost first;
  write_track(first, again.models, again.mean, order_of(0, 0), trajectory.residual);
  EXPECT_EQ(first.bits(), cost.bits);
  EXPECT_EQ(state.mean, again.mean);
  const TrackResiduals next(kFrames, Vec3i{9, -90, 900});
  BitCost after;
  BitCost after_again;
  write_track(after, state.models, state.mean, order_of(0, 0), next);
  write_track(after_again, again.models, again.mean, order_of(0, 0), next);
  EXPECT_EQ(after.bits(), after_again.bits());
}

// The frames between are interpolated where that is cheaper, and only then.
TEST(CodedTrajectories, AreHierarchicalIfThatIsCheaper) {
  const auto cost = [](const Values& values, int track_levels, int& between) {
    Trajectory trajectory;
    TrackState state(kFrames);
    const TrackCost of =
        code_trajectory(values, 3.0, {.track_levels = track_levels}, state, trajectory);
    between = trajectory.temporal_between;
    return lagrangian_cost(of);
  };
  const Values wave = values_of([](double f) {
    return std::array<double, 3>{25.0 * std::sin(0.4 * f), 20.0 * std::cos(0.37 * f),
                                 9.0 * std::sin(0.3 * f)};
  });
  int between = 0;
  const double sequential = cost(wave, 0, between);
  EXPECT_EQ(between, 0);
  EXPECT_LT(cost(wave, 1, between), 0.95 * sequential);
  EXPECT_GT(between, 0);
  cost(rough(), 1, between);
  EXPECT_EQ(between, 0);
}

constexpr double kPi = 3.14159265358979;

std::array<double, 4> turn(double angle, const std::array<double, 3>& axis) {
  const double s = std::sin(angle / 2) / std::hypot(axis[0], axis[1], axis[2]);
  return {std::cos(angle / 2), s * axis[0], s * axis[1], s * axis[2]};
}

// Returns a bone that rotates at constant speed while its pivot moves along a line.
std::vector<WantedPose> steady_poses(double speed) {
  std::vector<WantedPose> wanted(kFrames);
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    wanted[f].rotation = turn(speed * f, {1.0, 2.0, -0.5});
    wanted[f].origin = {1000.0 + 50.0 * f, -20.0 * f, 300.0};
  }
  return wanted;
}

Bone free_bone() {
  Bone bone;
  bone.pivot = {100, -200, 300};
  bone.rotation_flag = bone.origin_flag = true;
  bone.rotation_step_idx = 8 * 18;  // 2^-12 in the vector part of a quaternion
  bone.origin_step_idx = 8 * 2;     // 4: a quarter of a grid unit
  return bone;
}

// The tolerance of the angle is doubled: a quaternion represents half the angle.
void expect_close(const std::vector<WantedPose>& wanted, const BoneMotion& motion) {
  ASSERT_EQ(motion.poses.size(), wanted.size());
  for (std::size_t f = 0; f < wanted.size(); ++f) {
    double same = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
      same += wanted[f].rotation[c] * static_cast<double>(motion.poses[f].rotation[c]);
    }
    same /= static_cast<double>(1 << kQuaternionFractionBits);
    const double sine2 = 1.0 - same * same;  // for half the angle between the rotations
    ASSERT_LT(sine2, 3.1 * std::exp2(-24)) << f;
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_LE(std::abs(static_cast<double>(motion.poses[f].origin[c]) - wanted[f].origin[c]),
                4.001)
          << f;
    }
  }
}

void expect_equal(const BoneMotion& a, const BoneMotion& b) {
  ASSERT_EQ(a.poses.size(), b.poses.size());
  for (std::size_t f = 0; f < a.poses.size(); ++f) {
    EXPECT_EQ(a.poses[f].rotation, b.poses[f].rotation);
    EXPECT_EQ(a.poses[f].axes, b.poses[f].axes);
    EXPECT_EQ(a.poses[f].origin, b.poses[f].origin);
  }
}

TEST(CodedBones, FollowTheWantedPoses) {
  BoneTrackStates states(kFrames);
  std::vector<Bone> bones;
  std::vector<BoneMotion> motions;
  motions.reserve(3);
  for (std::int32_t b = 0; b < 3; ++b) {
    const auto wanted = steady_poses(0.1 * (b + 1));
    Bone bone = free_bone();
    bone.parent = b - 1;
    motions.push_back(code_bone(wanted, b == 0 ? nullptr : &motions.back(), {.track_levels = 1},
                                states, bone));
    bones.push_back(bone);
    expect_close(wanted, motions.back());
  }
  const std::vector<BoneMotion> decoded = recon_bones(bones, kFrames, 1);
  for (std::size_t b = 0; b < 3; ++b) expect_equal(decoded[b], motions[b]);
}

// A quaternion and its opposite are the same rotation.
TEST(CodedBones, IgnoreTheSignOfQuaternions) {
  auto wanted = steady_poses(2.0 * kPi / 20.0);  // three full turns
  for (std::size_t f = 0; f < wanted.size(); f += 3) {
    for (double& x : wanted[f].rotation) x = -x;
  }
  BoneTrackStates states(kFrames);
  Bone bone = free_bone();
  expect_close(wanted, code_bone(wanted, nullptr, {}, states, bone));
}

TEST(CodedBones, CostLittleInSteadyMotion) {
  BoneTrackStates states(kFrames);
  Bone bone = free_bone();
  code_bone(steady_poses(0.05), nullptr, {}, states, bone);
  EXPECT_GE(bone.origin_order, 2);
  EXPECT_GE(bone.rotation_order, 2);
  EXPECT_LT(bytes_of(bone.origin_residual), 35U);
  EXPECT_LT(bytes_of(bone.rotation_residual), 60U);
}

TEST(CodedBones, HaveNoResidualsWithoutFlags) {
  BoneTrackStates states(kFrames);
  Bone bone;
  bone.pivot = {7, 8, 9};
  const BoneMotion motion = code_bone(steady_poses(0.1), nullptr, {}, states, bone);
  EXPECT_TRUE(bone.rotation_residual.empty());
  EXPECT_TRUE(bone.origin_residual.empty());
  for (const BonePose& pose : motion.poses) {
    EXPECT_EQ(pose.rotation, kNoRotation);
    EXPECT_EQ(pose.origin, (Vec3l{7, 8, 9}));
  }
}

// The root shrinks by half and back, along axes of its own; the child takes that over.
TEST(CodedBones, FollowTheWantedStretch) {
  BoneTrackStates states(kFrames);
  std::vector<WantedPose> wanted = steady_poses(0.05);
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    const double factor = 0.75 + 0.25 * std::cos(0.2 * f);
    wanted[f].stretch = {factor, factor, 1.5 - 0.5 * factor};
  }
  Bone root = free_bone();
  root.stretch = Stretch::kOwnAxes;
  root.stretch_axes = {3000, -9000, 12000};
  root.stretch_step_idx = 8 * 14;  // 2^-14
  const BoneMotion motion = code_bone(wanted, nullptr, {.track_levels = 1}, states, root);
  EXPECT_TRUE(motion.is_stretched);
  EXPECT_LT(bytes_of(root.stretch_residual), 100U);
  const BoneAxes along = stretch_axes(root);
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      std::array<double, 3> image{};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
          image[c] += static_cast<double>(motion.poses[f].axes[k][c]) *
                      static_cast<double>(along[i][k]) * std::exp2(-60);
        }
      }
      // Larger than the rest shape it does not become.
      const double limit = std::min(wanted[f].stretch[i], 1.0);
      const double length = std::hypot(image[0], image[1], image[2]);
      EXPECT_NEAR(length, wanted[f].stretch[i] > 1.0 ? length : limit, 3e-4) << f << ' ' << i;
    }
  }
  Bone child = free_bone();
  child.parent = 0;
  const std::vector<BoneMotion> decoded = recon_bones(std::vector<Bone>{root}, kFrames, 1);
  expect_equal(decoded[0], motion);
  const BoneMotion below = code_bone(steady_poses(0.1), &motion, {}, states, child);
  EXPECT_TRUE(below.is_stretched);
}

}  // namespace
}  // namespace rlpc
