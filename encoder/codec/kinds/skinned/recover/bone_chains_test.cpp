#include "encoder/codec/kinds/skinned/recover/bone_chains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_rotations.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"
#include "encoder/testing/skinned_limb.h"

namespace rlpc {
namespace {

// A limb, and how its bones are found to be connected.
class ChainsOfLimb {
 public:
  ChainsOfLimb(std::vector<LimbBone> bones, const LimbOptions& options)
      : limb(std::move(bones), options),
        trajectories_(limb.frames, limb.frames.num_frames),
        rotations(find_bone_rotations(trajectories_, rings())),
        num_rotations(rotations.bones.size()),
        chains(connect_bones(trajectories_, rings(), rotations)) {}
  ChainsOfLimb(const ChainsOfLimb&) = delete;
  ChainsOfLimb& operator=(const ChainsOfLimb&) = delete;

  // Returns the bone of the limb that a found one is: of those that turn like it, the one that
  // moves its anchors.
  std::size_t true_bone(std::size_t found) const {
    std::size_t best = 0;
    double min = 1e9;
    for (std::size_t b = 0; b < limb.bones.size(); ++b) {
      double error = difference(b, rotations.bones[found].rotation);
      for (const std::uint32_t v : chains.bones[found].anchors) error -= limb.weights[v][b];
      if (error < min) best = b;
      min = std::min(error, min);
    }
    return best;
  }
  std::vector<std::size_t> true_bones() const {
    std::vector<std::size_t> list;
    for (std::size_t b = 0; b < chains.bones.size(); ++b) list.push_back(true_bone(b));
    return list;
  }
  // Returns the place of a point of the first frame in the coordinates of the trajectories.
  Vec3d in_extents(const Vec3d& p) const {
    const Vec3d vertex = limb.position(0, 0);
    return trajectories_.position(0, 0) + extents(1.0) * (p - vertex);
  }
  double extents(double length) const { return length * kLimbScale / trajectories_.extent(); }
  // Returns the number of vertices that follow a bone of the limb alone.
  std::size_t num_own(std::size_t true_bone) const {
    return static_cast<std::size_t>(
        std::count_if(limb.weights.begin(), limb.weights.end(),
                      [&](const auto& w) { return w[true_bone] == 1.0; }));
  }

 private:
  VertexRings rings() const { return vertex_rings(limb.rest.size(), limb.triangles); }
  double difference(std::size_t bone, const Rotations& found) const {
    const std::vector<Motion>& motion = limb.motions[bone];
    const Eigen::Matrix3d first = motion[0].leftCols<3>().transpose();
    double sum = 0.0;
    for (std::size_t f = 0; f < motion.size(); ++f) {
      sum += (motion[f].leftCols<3>() * first - found[f]).squaredNorm();
    }
    return sum;
  }

 public:
  SkinnedLimb limb;

 private:
  Trajectories trajectories_;

 public:
  BoneRotations rotations;
  std::size_t num_rotations;  // before bones that turn alike were told apart
  BoneChains chains;
};

void expect_own_anchors(const ChainsOfLimb& c) {
  for (std::size_t b = 0; b < c.chains.bones.size(); ++b) {
    const BoneChains::Bone& bone = c.chains.bones[b];
    const std::size_t is = c.true_bone(b);
    // Some vertices follow another bone so little that rounding hides it.
    EXPECT_GE(bone.anchors.size(), c.num_own(is)) << b;
    EXPECT_EQ(bone.parent, BoneChains::kNone);
    Vec3d mean = Vec3d::Zero();
    for (const std::uint32_t v : bone.anchors) {
      EXPECT_GT(c.limb.weights[v][is], 0.9999) << v;
      mean += c.in_extents(c.limb.position(0, v)) / static_cast<double>(bone.anchors.size());
    }
    EXPECT_LT((bone.pivot - mean).norm(), 1e-6);
  }
}

// Returns the part of the vertices whose candidates include all bones that they follow.
double part_with_candidates(const ChainsOfLimb& c) {
  const std::vector<std::size_t> bones = c.true_bones();
  std::size_t complete = 0;
  for (std::size_t v = 0; v < c.limb.weights.size(); ++v) {
    const std::vector<std::uint32_t>& list = c.chains.candidates[v];
    EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
    bool has_all = true;
    for (std::size_t b = 0; b < bones.size(); ++b) {
      if (c.limb.weights[v][bones[b]] < 0.02) continue;
      has_all = has_all && std::count(list.begin(), list.end(), b) == 1;
    }
    if (has_all) ++complete;
  }
  return static_cast<double>(complete) / static_cast<double>(c.limb.weights.size());
}

void expect_true_joints(const ChainsOfLimb& c) {
  for (const BoneChains::Joint& joint : c.chains.joints) {
    const std::size_t a = c.true_bone(joint.first);
    const std::size_t b = c.true_bone(joint.second);
    // The later bone begins where the earlier one ends.
    const std::size_t child = std::max(a, b);
    EXPECT_EQ(c.limb.bones[child].parent, static_cast<int>(std::min(a, b)));
    const Vec3d place = moved(c.limb.motions[child][0], c.limb.joints[child]);
    EXPECT_LT((joint.at - c.in_extents(place)).norm(), 1e-5);
  }
}

TEST(BoneChains, GiveEachBoneItsVerticesAndJoints) {
  const ChainsOfLimb c(limb_chain(std::array{1.0, 0.9, 1.1, 1.0}), {});
  ASSERT_EQ(c.chains.bones.size(), 4U);
  EXPECT_EQ(c.chains.order.size(), 4U);
  expect_own_anchors(c);
  EXPECT_GT(part_with_candidates(c), 0.98);
  EXPECT_EQ(c.chains.joints.size(), 3U);
  expect_true_joints(c);
}

TEST(BoneChains, FindTheJointsOfBranches) {
  std::vector<LimbBone> bones = limb_chain(std::array{1.0, 1.2});
  bones.push_back({.parent = 1, .along = {0.3, 1.2, 0.0}});
  bones.push_back({.parent = 2, .along = {0.0, 1.0, 0.3}});
  bones.push_back({.parent = 1, .along = {0.6, -0.9, 0.0}});
  const ChainsOfLimb c(bones, {.seed = 2, .blend = 0.3});
  ASSERT_EQ(c.chains.bones.size(), 5U);
  expect_own_anchors(c);
  EXPECT_GT(part_with_candidates(c), 0.95);
  EXPECT_EQ(c.chains.joints.size(), 4U);
  expect_true_joints(c);
}

TEST(BoneChains, HangBonesThatAlwaysBlend) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    const ChainsOfLimb c(limb_chain(std::array{1.0, 0.2, 1.0}),
                         {.seed = seed, .spacing = 0.05});
    ASSERT_EQ(c.chains.bones.size(), 3U);
    double max = 0.0;
    for (const auto& w : c.limb.weights) max = std::max(max, w[1]);
    ASSERT_LT(max, 0.6);
    for (std::size_t b = 0; b < 3; ++b) {
      const BoneChains::Bone& bone = c.chains.bones[b];
      EXPECT_EQ(bone.anchors.empty(), c.true_bone(b) == 1);
      EXPECT_EQ(bone.parent == BoneChains::kNone, c.true_bone(b) != 1);
      if (bone.anchors.empty()) {
        ASSERT_LT(bone.parent, 3U);
        EXPECT_FALSE(c.chains.bones[bone.parent].anchors.empty());
        EXPECT_EQ(c.chains.order.back(), b);
        // It hangs from a place where it has some weight.
        const Vec3d middle = c.limb.joints[1] + 0.5 * c.limb.bones[1].along;
        const Vec3d place = c.in_extents(moved(c.limb.motions[1][0], middle));
        EXPECT_LT((bone.pivot - place).norm(), c.extents(0.4));
      }
    }
    EXPECT_EQ(c.chains.order.size(), 3U);
    EXPECT_TRUE(c.chains.joints.empty());
    EXPECT_GT(part_with_candidates(c), 0.95);
  }
}

// A chain of such bones hangs one from the other.
TEST(BoneChains, HangBonesFromThoseThatHang) {
  const ChainsOfLimb c(limb_chain(std::array{1.0, 0.3, 0.2}), {.spacing = 0.05});
  ASSERT_EQ(c.chains.bones.size(), 3U);
  ASSERT_EQ(c.chains.order.size(), 3U);
  EXPECT_EQ(c.true_bone(c.chains.order[0]), 0U);
  for (std::size_t i = 1; i < 3; ++i) {
    const BoneChains::Bone& bone = c.chains.bones[c.chains.order[i]];
    EXPECT_TRUE(bone.anchors.empty());
    const auto before = c.chains.order.begin() + static_cast<std::ptrdiff_t>(i);
    EXPECT_NE(std::find(c.chains.order.begin(), before, bone.parent), before);
  }
}

TEST(BoneChains, TellBonesThatTurnAlikeApart) {
  std::vector<LimbBone> bones = limb_chain(std::array{1.0, 1.0});
  bones.push_back({.along = {1.0, 0.0, 0.0}, .from = {0.0, 2.0, 0.0}, .turns_like = 0});
  const ChainsOfLimb c(bones, {.seed = 3});
  EXPECT_EQ(c.num_rotations, 2U);
  ASSERT_EQ(c.chains.bones.size(), 3U);
  EXPECT_EQ(c.rotations.bones.size(), 3U);
  std::vector<std::size_t> list = c.true_bones();
  std::sort(list.begin(), list.end());
  EXPECT_EQ(list, (std::vector<std::size_t>{0, 1, 2}));
  expect_own_anchors(c);
  EXPECT_EQ(c.chains.order.size(), 3U);
  EXPECT_EQ(c.chains.joints.size(), 1U);
  expect_true_joints(c);
}

}  // namespace
}  // namespace rlpc
