#include "common/codec/kinds/skinned/recon/bones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <vector>

#include "common/codec/bits/residual_models.h"
#include "common/codec/components/series_predictor.h"
#include "common/codec/kinds/cluster/cluster_gof.h"

namespace rlpc {
namespace {

constexpr double kOne = 1 << kQuaternionFractionBits;
constexpr std::int64_t kOneI = std::int64_t{1} << kQuaternionFractionBits;
constexpr auto kMost = static_cast<std::int32_t>(kMaxResidual);

using Real4 = std::array<double, 4>;
using Real3 = std::array<double, 3>;

double length_of(const Quaternion& q) {
  double sum = 0.0;
  for (const std::int64_t x : q) sum += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(sum);
}

Real4 unit(const Quaternion& q) {
  const double n = length_of(q);
  Real4 u{};
  for (std::size_t c = 0; c < 4; ++c) u[c] = static_cast<double>(q[c]) / n;
  return u;
}

// The quaternion product in floating point, in vector form, as an independent reference.
Real4 times(const Real4& p, const Real4& q) {
  const auto cross = [](const Real4& a, const Real4& b, std::size_t c) {
    const std::size_t i = 1 + c % 3;
    const std::size_t k = 1 + (c + 1) % 3;
    return a[i] * b[k] - a[k] * b[i];
  };
  Real4 r{p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]};
  for (std::size_t c = 1; c < 4; ++c) r[c] = p[0] * q[c] + q[0] * p[c] + cross(p, q, c);
  return r;
}

// q (0, v) q*
Real3 turned(const Real4& q, const Real3& v) {
  const Real4 r = times(times(q, {0.0, v[0], v[1], v[2]}), {q[0], -q[1], -q[2], -q[3]});
  return {r[1], r[2], r[3]};
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  std::int64_t magnitude_below(std::int64_t n) {
    const auto x = static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(n));
    return engine_() % 2 == 0 ? x : -x;
  }
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(engine_() % n); }
  Quaternion quaternion(int bits) {
    Quaternion q{};
    for (std::int64_t& x : q) x = magnitude_below(std::int64_t{1} << bits);
    return q;
  }
  Quaternion rotation() { return normalize_quaternion(quaternion(40)); }

 private:
  std::mt19937_64 engine_;
};

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

TEST(Quaternions, ZeroIsNormalisedToNoRotation) {
  EXPECT_EQ(normalize_quaternion({0, 0, 0, 0}), kNoRotation);
}

TEST(Quaternions, OnAnAxisAreExact) {
  for (const std::int64_t x :
       {std::int64_t{1}, std::int64_t{12345}, (std::int64_t{1} << 56) - 1}) {
    EXPECT_EQ(normalize_quaternion({x, 0, 0, 0}), kNoRotation) << x;
    EXPECT_EQ(normalize_quaternion({0, 0, -x, 0}), (Quaternion{0, 0, -kOneI, 0})) << x;
  }
}

// The bounds of 8.12.4, for coordinates of every width up to 56 bits.
TEST(Quaternions, AreOfUnitLengthAndKeepTheirDirection) {
  Random random(1);
  for (int bits = 1; bits <= 56; ++bits) {
    for (int i = 0; i < 300; ++i) {
      Quaternion q = random.quaternion(bits);
      if (i % 3 == 0) q[random.below(4)] = (std::int64_t{1} << bits) - 1;
      if (i % 5 == 0) q[random.below(4)] = -(std::int64_t{1} << bits) + 1;
      const Quaternion u = normalize_quaternion(q);
      ASSERT_LT(length_of(u), kOne + 8.0) << bits;
      ASSERT_GT(length_of(u), kOne - 8.0) << bits;
      if (q == Quaternion{}) continue;
      const Real4 exact = unit(q);
      for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_LE(std::abs(u[c]), kOneI);
        // Scaling to 29 bits causes an error of 1/2 per coordinate: 2 here, and 4 in the norm.
        ASSERT_NEAR(static_cast<double>(u[c]), exact[c] * kOne, 8.0) << bits;
      }
    }
  }
}

TEST(Quaternions, ProductsAreHamiltonProducts) {
  Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const Quaternion p = random.rotation();
    const Quaternion q = i % 2 == 0 ? random.rotation() : random.quaternion(30);
    Quaternion corner{kOneI, kOneI - 1, -kOneI, kOneI - 1};  // the maximum length
    if (i % 7 == 0) std::rotate(corner.begin(), corner.begin() + i % 4, corner.end());
    const Quaternion& second = i % 7 == 0 ? corner : q;
    if (length_of(second) < kOne / 16) continue;  // too short to have a precise direction
    const Quaternion r = rotation_after(p, second);
    const Real4 exact = times(unit(p), unit(second));
    for (std::size_t c = 0; c < 4; ++c) {
      ASSERT_NEAR(static_cast<double>(r[c]), exact[c] * kOne, 32.0) << i;
    }
  }
}

// Bit-exact results of the pseudo-code of 8.12.4.
TEST(Quaternions, AgreeWithThePseudoCode) {
  const Quaternion p = normalize_quaternion({3, -1, 2, 5});
  const Quaternion q = normalize_quaternion({7, 1, -1, 1});
  EXPECT_EQ(p, (Quaternion{515808888, -171936296, 343872592, 859681480}));
  EXPECT_EQ(normalize_quaternion({-123456789012345, 98765432109876, 5, -1}),
            (Quaternion{-838451497, 670761205, 0, 0}));
  EXPECT_EQ(
      normalize_quaternion({72057594037927935, -36028797018963965, 18014398509481991, -12345}),
      (Quaternion{937238702, -468619351, 234309676, 0}));
  EXPECT_EQ(rotation_after(p, q), (Quaternion{453022211, 71529822, 405335663, 882201148}));
  EXPECT_EQ(rotation_after(q, p), (Quaternion{453022212, -262276016, 119216372, 929887698}));
  EXPECT_EQ(rotation_after(p, {kOneI, 1 << 20, -kOneI, 12345}),
            (Quaternion{607998198, 486668146, -120982254, 729230488}));
  EXPECT_EQ(axes_of(p), (std::array<Vec3l, 3>{{{-523104992, 715827883, -605700517},
                                               {-936082616, -357913942, 385445783},
                                               {55063683, 715827883, 798423407}}}));
}

TEST(Quaternions, NoRotationIsNeutral) {
  EXPECT_EQ(rotation_after(kNoRotation, kNoRotation), kNoRotation);
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Quaternion q = random.rotation();
    for (const Quaternion& r :
         {rotation_after(kNoRotation, q), rotation_after(q, kNoRotation)}) {
      for (std::size_t c = 0; c < 4; ++c) {
        ASSERT_NEAR(static_cast<double>(r[c]), static_cast<double>(q[c]), 8.0);
      }
    }
  }
}

TEST(Axes, AreExactForNoRotationAndQuarterTurns) {
  EXPECT_EQ(axes_of(kNoRotation),
            (std::array<Vec3l, 3>{{{kOneI, 0, 0}, {0, kOneI, 0}, {0, 0, kOneI}}}));
  const Quaternion about_z = normalize_quaternion({1 << 20, 0, 0, 1 << 20});
  const auto axes = axes_of(about_z);
  const std::array<Vec3l, 3> exact{{{0, kOneI, 0}, {-kOneI, 0, 0}, {0, 0, kOneI}}};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_LE(std::abs(axes[k][c] - exact[k][c]), 4) << k << c;
  }
}

TEST(Axes, AreTheRotatedAxes) {
  Random random(4);
  for (int i = 0; i < 5000; ++i) {
    const Quaternion q = random.rotation();
    const auto axes = axes_of(q);
    for (std::size_t k = 0; k < 3; ++k) {
      Real3 axis{};
      axis[k] = 1.0;
      const Real3 exact = turned(unit(q), axis);
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(static_cast<double>(axes[k][c]), exact[c] * kOne, 24.0);
        ASSERT_LE(std::abs(axes[k][c]), kOneI + 16) << "the bound of 8.12.3";
      }
    }
  }
}

TEST(MovedPoint, MapsThePivotToTheOrigin) {
  Random random(5);
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
  Random random(6);
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
        turn[c + 1] = std::clamp(
            rotation[c] * static_cast<double>(step_of(bone_.rotation_step_idx)) / kOne, -1.0,
            1.0);
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

Bone random_bone(Random& random, std::size_t index) {
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
    Random random(seed);
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
          ASSERT_NEAR(static_cast<double>(pose.rotation[c]) / kOne, exact[b].rotations[f][c],
                      1e-4)
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
  Random random(7);
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
  Random random(8);
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
    bone.rotation_residual = {{sign * kMost, 0, 0}, {sign * kMost, 0, 0}};  // from there on
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
        const std::int32_t now = f / 3 % 2 == b % 2 ? kMost : -kMost;
        bone.rotation_residual.push_back({now, -now, f % 2 == 0 ? now : 0});
        bone.origin_residual.push_back({now, f % 7 == 0 ? -now : now, -now});
      }
    }
    bool reached = false;
    for (const BoneMotion& motion : recon_bones(bones, 40, 0)) {
      for (const BonePose& pose : motion.poses) {
        EXPECT_NEAR(length_of(pose.rotation), kOne, 8.0);
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

}  // namespace
}  // namespace rlpc
