#include "common/codec/kinds/skinned/recon/bones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "common/codec/components/series_predictor.h"
#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/testing/real_quaternions.h"
#include "common/testing/residual_bound.h"

namespace rlpc {
namespace {

TEST(Steps, DoubleEveryEighth) {
  EXPECT_EQ(step_of(0), 1);
  EXPECT_EQ(step_of(80), 1024);
  EXPECT_EQ(step_of(84), 1448);  // 1024 * 2^(4 / 8)
  EXPECT_LT(step_of(kMaxStepIdx), std::int64_t{1} << 30);
  for (std::uint32_t idx = 0; idx <= kMaxStepIdx; ++idx) {
    const double exact = std::exp2(idx / 8.0);
    EXPECT_NEAR(static_cast<double>(step_of(idx)), exact, 0.5 + exact / 65536.0) << idx;
  }
}

TEST(MovedPoint, MapsThePivotToTheOrigin) {
  RandomRotations random(5);
  BonePose pose;
  pose.rotation = random.rotation();
  pose.axes = axes_of(pose.rotation);
  pose.origin = {-7, 1 << 30, 12345};
  EXPECT_EQ(moved_point(pose, {1000, -2000, 3000}, {1000, -2000, 3000}), pose.origin);
}

TEST(MovedPoint, IsRoundedToTheNearest) {
  BonePose pose;
  pose.axes[0] = {kOneI / 2, -kOneI / 2, kOneI / 4};
  const Vec3l pivot{10, 0, 0};
  EXPECT_EQ(moved_point(pose, pivot, {13, 0, 0}), (Vec3l{2, -1, 1}));  // 3/2, -3/2, 3/4
  EXPECT_EQ(moved_point(pose, pivot, {7, 0, 0}), (Vec3l{-1, 2, -1}));
}

// Compares points and pivots at the ends of their ranges with floating point; an overflow would
// exceed the tolerance by far.
TEST(MovedPoint, IsAccurateAtTheEndsOfItsRange) {
  RandomRotations random(6);
  constexpr std::int64_t kPoint = (std::int64_t{1} << 31) - 1;
  constexpr std::int64_t kPivot = std::int64_t{1} << 28;
  for (int i = 0; i < 5000; ++i) {
    // Rotating the main diagonal onto an axis maximises the sum of products.
    const Quaternion q =
        i % 2 == 0 ? random.rotation()
                   : normalize_quaternion({888'073'834, 0, 325'057'583 * (i % 4 - 2),
                                           -325'057'583 + random.magnitude_below(1 << 28)});
    BonePose pose;
    pose.rotation = q;
    pose.axes = axes_of(q);
    Vec3l point{};
    Vec3l pivot{};
    Real3 arm{};
    for (std::size_t c = 0; c < 3; ++c) {
      point[c] = random.below(2) == 0 ? kPoint : -kPoint;
      pivot[c] = point[c] > 0 ? -kPivot : kPivot - 1;
      pose.origin[c] = random.below(2) == 0 ? kOneI - 1 : -kOneI;
      arm[c] = static_cast<double>(point[c] - pivot[c]);
    }
    const Vec3l moved = moved_point(pose, pivot, point);
    const Real3 exact = turned(unit(q), arm);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_NEAR(static_cast<double>(moved[c] - pose.origin[c]), exact[c], 256.0) << i;
      ASSERT_LT(std::abs(moved[c]), std::int64_t{1} << 34);
    }
  }
}

// Motion of a bone (8.12.2) in floating point, except for the integer steps.
class RealBone {
 public:
  RealBone(const Bone& bone, const RealBone* parent) : bone_(bone), parent_(parent) {}

  void add(const Vec3i& rotation, const Vec3i& origin) {
    const std::size_t f = rotations.size();
    Real4 relative{1.0, 0.0, 0.0, 0.0};
    if (bone_.rotation_flag) {
      if (f > 0) relative = normalised(extrapolated<Real4>(relative_, bone_.rotation_order));
      Real4 turn{1.0};
      for (std::size_t c = 0; c < 3; ++c) {
        turn[c + 1] =
            std::clamp(rotation[c] * static_cast<double>(step_of(bone_.rotation_step_idx)) /
                           kQuaternionOne,
                       -1.0, 1.0);
      }
      relative = normalised(times(relative, turn));
    }
    relative_.push_back(relative);
    rotations.push_back(parent_ ? times(parent_->rotations[f], relative) : relative);
    Real3 place{};
    for (std::size_t c = 0; c < 3; ++c) place[c] = bone_.pivot[c];
    if (parent_) place = parent_->moved(f, place);
    Real3 offset{};
    if (bone_.origin_flag) {
      offset = extrapolated<Real3>(offsets_, bone_.origin_order);
      for (std::size_t c = 0; c < 3; ++c) {
        offset[c] += origin[c] * static_cast<double>(step_of(bone_.origin_step_idx));
      }
    }
    offsets_.push_back(offset);
    for (std::size_t c = 0; c < 3; ++c) place[c] += offset[c];
    origins.push_back(place);
  }

  Real3 moved(std::size_t f, const Real3& point) const {
    Real3 arm{};
    for (std::size_t c = 0; c < 3; ++c) arm[c] = point[c] - bone_.pivot[c];
    Real3 place = turned(rotations[f], arm);
    for (std::size_t c = 0; c < 3; ++c) place[c] += origins[f][c];
    return place;
  }

  std::vector<Real4> rotations;
  std::vector<Real3> origins;

 private:
  static Real4 normalised(const Real4& q) {
    const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    return {q[0] / n, q[1] / n, q[2] / n, q[3] / n};
  }
  // Extrapolates the polynomial through the last values; its degree is the order minus 1.
  template <class T>
  static T extrapolated(const std::vector<T>& series, int order) {
    T next{};
    const int n = std::min(order, static_cast<int>(series.size()));
    double binomial = 1.0;
    for (int k = 1; k <= n; ++k) {
      binomial *= static_cast<double>(n - k + 1) / k;
      for (std::size_t c = 0; c < next.size(); ++c) {
        next[c] += (k % 2 == 1 ? binomial : -binomial) *
                   series[series.size() - static_cast<std::size_t>(k)][c];
      }
    }
    return next;
  }

  const Bone& bone_;
  const RealBone* parent_;
  std::vector<Real4> relative_;
  std::vector<Real3> offsets_;
};

constexpr std::uint32_t kFrames = 16;

Bone random_bone(RandomRotations& random, std::size_t index) {
  Bone bone;
  bone.parent =
      static_cast<std::int32_t>(random.below(static_cast<std::uint32_t>(index) + 1)) - 1;
  bone.rotation_flag = random.below(4) != 0;
  bone.origin_flag = random.below(4) != 0;
  bone.rotation_order = 1 + static_cast<int>(random.below(kMaxPredictorOrder));
  bone.origin_order = static_cast<int>(random.below(kMaxPredictorOrder + 1));
  bone.rotation_step_idx = 140 + random.below(40);
  bone.origin_step_idx = random.below(60);
  for (std::int32_t& x : bone.pivot)
    x = static_cast<std::int32_t>(random.magnitude_below(1 << 20));
  bone.rotation_residual.resize(kFrames);
  bone.origin_residual.resize(kFrames);
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    // High-order polynomials would soon leave the range.
    const bool rare = f < 2 || f % 5 == 0;
    for (std::size_t c = 0; c < 3; ++c) {
      bone.rotation_residual[f][c] =
          static_cast<std::int32_t>(random.magnitude_below(rare ? 12 : 2));
      bone.origin_residual[f][c] =
          static_cast<std::int32_t>(random.magnitude_below(rare ? 200 : 20));
    }
  }
  return bone;
}

TEST(RandomBones, MoveAsInFloatingPoint) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    RandomRotations random(seed);
    std::vector<Bone> bones;
    for (std::size_t b = 0; b < 6; ++b) bones.push_back(random_bone(random, b));
    const std::vector<BoneMotion> motions = recon_bones(bones, kFrames, 0);
    ASSERT_EQ(motions.size(), bones.size());
    std::vector<RealBone> exact;
    exact.reserve(bones.size());
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const Bone& bone = bones[b];
      exact.emplace_back(
          bone, bone.parent < 0 ? nullptr : &exact[static_cast<std::size_t>(bone.parent)]);
      ASSERT_EQ(motions[b].poses.size(), kFrames);
      for (std::uint32_t f = 0; f < kFrames; ++f) {
        exact[b].add(bone.rotation_residual[f], bone.origin_residual[f]);
        const BonePose& pose = motions[b].poses[f];
        EXPECT_EQ(pose.axes, axes_of(pose.rotation));
        for (std::size_t c = 0; c < 4; ++c) {
          // Under order 4, rounding errors grow with the cube of the number of frames.
          ASSERT_NEAR(static_cast<double>(pose.rotation[c]) / kQuaternionOne,
                      exact[b].rotations[f][c], 1e-4)
              << b << " " << f;
        }
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_NEAR(static_cast<double>(pose.origin[c]), exact[b].origins[f][c], 400.0)
              << b << " " << f;
        }
      }
    }
  }
}

// Residuals are ignored if the flags are off.
TEST(Bones, StayOrFollowTheirParentWithoutFlags) {
  RandomRotations random(7);
  Bone still;
  still.pivot = {5, -6, 7};
  still.rotation_residual = still.origin_residual = TrackResiduals(kFrames, Vec3i{9, 9, 9});
  const BoneMotion alone = recon_bones(std::vector<Bone>{still}, kFrames, 0)[0];
  for (const BonePose& pose : alone.poses) {
    EXPECT_EQ(pose.rotation, kNoRotation);
    EXPECT_EQ(pose.origin, (Vec3l{5, -6, 7}));
  }
  Bone parent = random_bone(random, 0);
  parent.rotation_flag = parent.origin_flag = true;
  still.parent = 0;
  const std::vector<BoneMotion> motions =
      recon_bones(std::vector<Bone>{parent, still}, kFrames, 0);
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    const BonePose& pose = motions[1].poses[f];
    EXPECT_EQ(pose.origin, moved_point(motions[0].poses[f], motions[0].pivot, {5, -6, 7}));
    // The rotation of the parent, normalised once more.
    EXPECT_EQ(pose.rotation, rotation_after(motions[0].poses[f].rotation, kNoRotation));
  }
}

// Where the residual of a frame is zero, the motion equals the prediction from the preceding
// frames in the order of the track.
TEST(Bones, ZeroResidualsReproduceThePredictions) {
  RandomRotations random(8);
  for (int i = 0; i < 150; ++i) {
    Bone bone = random_bone(random, 0);
    bone.rotation_flag = bone.origin_flag = true;
    bone.rotation_between = bone.origin_between = i % 3;
    const int levels = i / 3 % 5;
    const std::vector<TrackPlace> order = track_order(kFrames, levels, i % 3);
    const TrackPlace& at = order[random.below(kFrames)];
    bone.rotation_residual[at.frame] = bone.origin_residual[at.frame] = {};
    const BoneMotion motion = recon_bones(std::vector<Bone>{bone}, kFrames, levels)[0];
    const auto rotation = [&](std::uint32_t f) { return motion.poses[f].rotation; };
    const Quaternion predicted = predict_rotation(rotation, at, bone.rotation_order);
    EXPECT_EQ(motion.poses[at.frame].rotation, rotation_after(predicted, kNoRotation));
    for (std::size_t c = 0; c < 3; ++c) {
      const auto offset = [&](std::uint32_t f) {
        return motion.poses[f].origin[c] - bone.pivot[c];
      };
      EXPECT_EQ(offset(at.frame), predict_offset(offset, at, bone.origin_order));
    }
  }
}

// Half a circle before and after, with either sign: the rotation between is a quarter turn.
TEST(Bones, RotationsBetweenAreMeans) {
  constexpr std::int64_t kRoot = 759'250'126;  // square root of a half, rounded up
  const TrackPlace at{.frame = 1, .stride = 1, .level = 1, .neighbours = 2};
  for (const std::int64_t sign : {1, -1}) {
    const std::array<Quaternion, 3> known{kNoRotation, Quaternion{}, {0, sign * kOneI, 0, 0}};
    const Quaternion mean = predict_rotation([&](std::uint32_t f) { return known[f]; }, at, 1);
    EXPECT_EQ(mean, (Quaternion{kRoot, sign * kRoot, 0, 0}));
    const std::array<Quaternion, 3> opposite{
        kNoRotation, Quaternion{}, {-kRoot, -sign * kRoot, 0, 0}};
    EXPECT_EQ(predict_rotation([&](std::uint32_t f) { return opposite[f]; }, at, 1),
              normalize_quaternion({kOneI + kRoot, sign * kRoot, 0, 0}));
  }
}

// The vector part of a rotation is clipped to 31 bits: a quarter turn about an axis, in either
// direction.
TEST(Bones, TheLargestRotationIsAQuarterTurn) {
  for (const int sign : {1, -1}) {
    Bone bone;
    bone.rotation_flag = true;
    bone.rotation_step_idx = kMaxStepIdx;
    bone.rotation_residual = {{sign * kResidualBound, 0, 0},
                              {sign * kResidualBound, 0, 0}};  // from there on
    const BoneMotion motion = recon_bones(std::vector<Bone>{bone}, 2, 0)[0];
    const auto& axes = motion.poses[0].axes;
    EXPECT_LE(std::abs(axes[1][2] - sign * kOneI), 16);
    EXPECT_LE(std::abs(axes[1][1]), 16);
    EXPECT_LE(std::abs(motion.poses[1].axes[1][1] + kOneI), 16);
  }
}

// Residuals that jump between their bounds, at the largest steps, through a chain of bones.
TEST(Bones, OriginsAreClippedToTheirRange) {
  for (int order = 0; order <= kMaxPredictorOrder; ++order) {
    std::vector<Bone> bones(5);
    for (std::size_t b = 0; b < bones.size(); ++b) {
      Bone& bone = bones[b];
      bone.parent = static_cast<std::int32_t>(b) - 1;
      bone.rotation_flag = bone.origin_flag = true;
      bone.rotation_step_idx = bone.origin_step_idx = kMaxStepIdx;
      bone.rotation_order = std::max(order, 1);
      bone.origin_order = order;
      bone.pivot = {-(1 << 28), (1 << 28) - 1, b % 2 == 0 ? 1 << 27 : -(1 << 28)};
      for (std::uint32_t f = 0; f < 40; ++f) {
        const std::int32_t now = f / 3 % 2 == b % 2 ? kResidualBound : -kResidualBound;
        bone.rotation_residual.push_back({now, -now, f % 2 == 0 ? now : 0});
        bone.origin_residual.push_back({now, f % 7 == 0 ? -now : now, -now});
      }
    }
    bool reached = false;
    for (const BoneMotion& motion : recon_bones(bones, 40, 0)) {
      for (const BonePose& pose : motion.poses) {
        EXPECT_NEAR(length_of(pose.rotation), kQuaternionOne, 8.0);
        for (const std::int64_t x : pose.origin) {
          EXPECT_GE(x, -kOneI);
          EXPECT_LT(x, kOneI);
          reached = reached || x == -kOneI || x == kOneI - 1;
        }
      }
    }
    EXPECT_TRUE(reached) << order;
  }
}

constexpr std::int64_t kFactorOne = std::int64_t{1} << kStretchFractionBits;

Bone stretched_bone(RandomRotations& random, std::size_t b) {
  Bone bone = random_bone(random, b);
  bone.stretch = static_cast<Stretch>(random.below(3));
  if (bone.stretch == Stretch::kOwnAxes) {
    for (std::int32_t& x : bone.stretch_axes) {
      x = static_cast<std::int32_t>(random.magnitude_below(1 << 15));
    }
  }
  bone.stretch_step_idx = 8 * 20;
  bone.stretch_order = static_cast<int>(random.below(3));
  bone.stretch_residual.resize(kFrames);
  for (Vec3i& residual : bone.stretch_residual) {
    for (std::int32_t& x : residual) x = static_cast<std::int32_t>(random.magnitude_below(40));
  }
  return bone;
}

using RealAxes = std::array<std::array<double, 3>, 3>;  // images of the axes

RealAxes real(const BoneAxes& axes) {
  RealAxes result{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      result[k][c] = static_cast<double>(axes[k][c]) / kQuaternionOne;
    }
  }
  return result;
}

RealAxes product(const RealAxes& p, const RealAxes& q) {
  RealAxes result{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < 3; ++i) result[k][c] += p[i][c] * q[k][i];
    }
  }
  return result;
}

// The images under diag( factors ) in a coordinate frame.
RealAxes real_stretch(const RealAxes& along, const std::array<double, 3>& factors) {
  RealAxes result{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < 3; ++i) {
        result[k][c] += factors[i] * along[i][k] * along[i][c];
      }
    }
  }
  return result;
}

// Rotations relative to the parent and stretches are those of a bone without a parent.
TEST(StretchedBones, AreScaledThenTurnedThenMovedWithTheirParent) {
  std::size_t num_clipped = 0;
  std::size_t num_free = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    RandomRotations random(seed);
    std::vector<Bone> bones;
    for (std::size_t b = 0; b < 4; ++b) bones.push_back(stretched_bone(random, b));
    const std::vector<BoneMotion> motions = recon_bones(bones, kFrames, 0);
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const Bone& bone = bones[b];
      const bool parent_stretches =
          bone.parent >= 0 && motions[static_cast<std::size_t>(bone.parent)].is_stretched;
      EXPECT_EQ(motions[b].is_stretched, bone.stretch != Stretch::kNone || parent_stretches);
      if (!motions[b].is_stretched) continue;
      Bone alone = bone;
      alone.parent = -1;
      alone.stretch = Stretch::kNone;
      const BoneMotion turning = recon_bones(std::vector<Bone>{alone}, kFrames, 0)[0];
      std::array<std::vector<std::int64_t>, 3> series;
      for (std::uint32_t f = 0; f < kFrames; ++f) {
        std::array<double, 3> factors{1.0, 1.0, 1.0};
        for (std::size_t c = 0; c < 3 && bone.stretch != Stretch::kNone; ++c) {
          const auto known = [&](std::uint32_t i) { return series[c][i]; };
          series[c].push_back(
              std::clamp(predict_series(known, f, bone.stretch_order) +
                             std::int64_t{bone.stretch_residual[f][c]} * (1 << 20),
                         -kOneI, kOneI - 1));
        }
        for (std::size_t i = 0; i < 3 && bone.stretch != Stretch::kNone; ++i) {
          const std::int64_t factor = kFactorOne + series[0][f] + (i == 0 ? 0 : series[i][f]);
          factors[i] = std::clamp(static_cast<double>(factor) / kFactorOne, 0.0, 4.0);
        }
        RealAxes expected = product(real(turning.poses[f].axes),
                                    real_stretch(real(stretch_axes(bone)), factors));
        if (bone.parent >= 0) {
          const auto parent = static_cast<std::size_t>(bone.parent);
          expected = product(real(motions[parent].poses[f].axes), expected);
        }
        const RealAxes found = real(motions[b].poses[f].axes);
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_NEAR(found[k][c], std::clamp(expected[k][c], -1.0, 1.0), 1e-7) << b;
            ++(std::abs(expected[k][c]) > 1.0 ? num_clipped : num_free);
          }
        }
      }
    }
  }
  EXPECT_GT(num_clipped, 100U);
  EXPECT_GT(num_free, 10000U);
}

TEST(StretchedBones, KeepTheRestShapeWithoutDifferences) {
  Bone bone;
  bone.stretch = Stretch::kRestAxes;
  bone.stretch_residual.resize(2);
  const auto motions = recon_bones(std::vector<Bone>{bone}, 2, 0);
  for (const BonePose& pose : motions[0].poses) {
    EXPECT_EQ(pose.axes, axes_of(kNoRotation));
  }
}

// Differences that jump between their bounds, at the largest steps, through a chain of bones.
TEST(StretchedBones, AreClippedToTheirRange) {
  std::vector<Bone> bones(4);
  for (std::size_t b = 0; b < bones.size(); ++b) {
    bones[b].parent = static_cast<std::int32_t>(b) - 1;
    bones[b].stretch = Stretch::kOwnAxes;
    bones[b].stretch_axes = {-32768, 32767, b % 2 == 0 ? 20000 : -32768};
    bones[b].stretch_step_idx = kMaxStepIdx;
    for (std::int32_t f = 0; f < 20; ++f) {
      const std::int32_t now = f / 2 % 2 == 0 ? kResidualBound : -kResidualBound;
      bones[b].stretch_residual.push_back({now, f % 3 == 0 ? now : -now, f % 5});
    }
  }
  bool reached = false;
  for (const BoneMotion& motion : recon_bones(bones, 20, 0)) {
    for (const BonePose& pose : motion.poses) {
      for (const Vec3l& axis : pose.axes) {
        for (const std::int64_t x : axis) {
          EXPECT_LE(std::abs(x), kOneI);
          reached = reached || std::abs(x) == kOneI;
        }
      }
    }
  }
  EXPECT_TRUE(reached);
}

}  // namespace
}  // namespace rlpc
