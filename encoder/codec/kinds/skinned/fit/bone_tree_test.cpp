#include "encoder/codec/kinds/skinned/fit/bone_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "encoder/testing/random_points.h"
#include "encoder/testing/rigid.h"

namespace rlpc {
namespace {

constexpr std::size_t kChainFrames = 12;
constexpr double kAlways = std::numeric_limits<double>::infinity();
constexpr double kNever = -1.0;

using Motions = std::vector<std::vector<Motion>>;  // [bone][frame]

Eigen::Matrix3d turn_by(const Vec3d& v) {
  return rotation_matrix(normalised({1.0, 0.5 * v(0), 0.5 * v(1), 0.5 * v(2)}));
}

Motion chained(const Motion& a, const Motion& b) {  // applies b, then a
  Motion m;
  m.leftCols<3>() = a.leftCols<3>() * b.leftCols<3>();
  m.col(3) = moved(a, b.col(3));
  return m;
}

Motion turn_about(const Vec3d& pivot, const Vec3d& turn) {
  Motion m;
  m.leftCols<3>() = turn_by(turn);
  m.col(3) = pivot - m.leftCols<3>() * pivot;
  return m;
}

// Rigid links along x, joined at 10, 20, ... Each link rotates by `swing` about the end of the
// one before, with an offset of `gap`. The whole chain moves.
struct Chain {
  std::vector<std::size_t> bone_of_link;  // a permutation
  std::vector<std::vector<Vec3d>> rest;   // [bone]
  Motions motions;

  Chain(std::vector<std::size_t> order, double swing, double gap, bool hinge = false)
      : bone_of_link(std::move(order)), rest(links()), motions(links()) {
    RandomPoints random(7);
    for (std::size_t l = 0; l < links(); ++l) {
      for (std::size_t v = 0; v < 9 - l; ++v) {  // the first link is the heaviest
        rest[bone_of_link[l]].push_back(joint(l) + Vec3d(5, 0, 0) + 4.0 * random.point());
      }
    }
    std::vector<Vec3d> phase;
    for (std::size_t l = 0; l < links(); ++l) phase.push_back(3.0 * random.point());
    for (std::size_t f = 0; f < kChainFrames; ++f) {
      Motion m = turn_about({0, 0, 0}, 0.1 * static_cast<double>(f) * Vec3d(1, 2, 0));
      m.col(3) += Vec3d(0, 3.0 * static_cast<double>(f), 0);
      for (std::size_t l = 0; l < links(); ++l) {
        if (l > 0) {
          const double time = 0.6 * static_cast<double>(f * (l + 1));
          Vec3d turn(std::sin(time + phase[l](0)), std::sin(time + phase[l](1)),
                     std::sin(time + phase[l](2)));
          if (hinge) turn(0) = turn(1) = 0.0;
          m = chained(m, turn_about(joint(l), swing * turn));
          m.col(3) += gap * random.point();
        }
        motions[bone_of_link[l]].push_back(m);
      }
    }
  }
  std::size_t links() const { return bone_of_link.size(); }
  static Vec3d joint(std::size_t link) { return {10.0 * static_cast<double>(link), 0, 0}; }
  SkinMoments moments() const {
    SkinMoments result(links());
    for (std::size_t b = 0; b < links(); ++b) {
      for (const Vec3d& p : rest[b]) {
        result.add(p, std::vector<RigWeight>{{static_cast<std::uint32_t>(b), 1.0}});
      }
    }
    return result;
  }
  // Returns squared distances between the vertices of a bone under other motions and its own.
  double damage(std::size_t bone, const std::vector<Motion>& other) const {
    double sum = 0.0;
    for (std::size_t f = 0; f < kChainFrames; ++f) {
      for (const Vec3d& p : rest[bone]) {
        sum += (moved(other[f], p) - moved(motions[bone][f], p)).squaredNorm();
      }
    }
    return sum;
  }
};

void expect_tree(const std::vector<TreeBone>& tree, std::size_t num_bones) {
  ASSERT_EQ(tree.size(), num_bones);
  std::vector<std::size_t> bones;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    bones.push_back(tree[i].bone);
    EXPECT_LT(tree[i].parent, static_cast<int>(i));
    EXPECT_EQ(tree[i].parent < 0, i == 0);
    EXPECT_TRUE(tree[i].pivot.allFinite());
  }
  std::sort(bones.begin(), bones.end());
  for (std::size_t b = 0; b < num_bones; ++b) EXPECT_EQ(bones[b], b);
  EXPECT_FALSE(tree[0].pinned);
}

TEST(BoneTree, PutsThePivotOfASingleBoneAtItsCentre) {
  SkinMoments moments(1);
  moments.add({1, 2, 3}, std::vector<RigWeight>{{0, 1.0}});
  moments.add({3, 2, 1}, std::vector<RigWeight>{{0, 1.0}});
  Motion identity = Motion::Zero();
  identity.leftCols<3>().setIdentity();
  Motions motions{{identity}};
  const auto tree = build_bone_tree(moments, kAlways, motions);
  expect_tree(tree, 1);
  EXPECT_EQ(tree[0].pivot, Vec3d(2, 2, 2));
  EXPECT_EQ(motions, Motions{{identity}});
}

// Starts at the heaviest bone, whatever the numbering; the pivots are the joints.
TEST(BoneTree, FollowsAChain) {
  const Chain chain({2, 0, 3, 1}, 0.5, 0.0);
  Motions motions = chain.motions;
  const auto tree = build_bone_tree(chain.moments(), kNever, motions);
  expect_tree(tree, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(tree[i].bone, chain.bone_of_link[i]) << i;
    EXPECT_EQ(tree[i].parent, static_cast<int>(i) - 1);
    EXPECT_FALSE(tree[i].pinned);
  }
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_LT((tree[i].pivot - Chain::joint(i)).norm(), 0.01) << tree[i].pivot;
  }
  EXPECT_EQ(motions, chain.motions);
}

// A root in the middle has children on both sides.
TEST(BoneTree, BranchesAtTheHeaviestBone) {
  Chain chain({0, 1, 2}, 0.5, 0.0);
  for (int i = 0; i < 20; ++i) chain.rest[1].push_back(Vec3d(15, 0.1 * i, 0));
  const auto tree = build_bone_tree(chain.moments(), kNever, chain.motions);
  expect_tree(tree, 3);
  EXPECT_EQ(tree[0].bone, 1U);
  EXPECT_EQ(tree[1].parent, 0);
  EXPECT_EQ(tree[2].parent, 0);
  for (std::size_t i : {1U, 2U}) {
    const std::size_t joint = std::max<std::size_t>(tree[i].bone, 1);
    EXPECT_LT((tree[i].pivot - Chain::joint(joint)).norm(), 0.01);
  }
}

// All points on the axis of a hinge are equivalent: the pivot is near the vertices of the bone.
TEST(BoneTree, PutsThePivotOfAHingeNearTheBone) {
  Chain chain({0, 1}, 0.5, 0.0, true);
  for (Vec3d& p : chain.rest[1]) p(2) += 30.0;
  const auto tree = build_bone_tree(chain.moments(), kNever, chain.motions);
  expect_tree(tree, 2);
  EXPECT_LT((tree[1].pivot.head<2>() - Vec3d(10, 0, 0).head<2>()).norm(), 0.01);
  EXPECT_NEAR(tree[1].pivot(2), 30.0, 4.0);
}

// Three bones in a row; the last rotates like the root. Its parent is the middle bone if the
// last bone is small, because its gap to the root is large, and the root if that gap is small.
TEST(BoneTree, WeighsGapsAgainstRotation) {
  for (const bool far : {false, true}) {
    Chain chain({0, 1, 2}, 0.5, 0.0);
    const Vec3d joint = far ? Chain::joint(2) : Chain::joint(1);
    for (std::size_t f = 0; f < kChainFrames; ++f) {
      Motion& middle = chain.motions[1][f];
      if (!far) middle.col(3) += Vec3d(0, 0, f % 2 == 0 ? 0.01 : -0.01);
      Motion& last = chain.motions[2][f];
      last.leftCols<3>() = chain.motions[0][f].leftCols<3>();
      last.col(3) = moved(middle, joint) - last.leftCols<3>() * joint;
    }
    const auto tree = build_bone_tree(chain.moments(), kNever, chain.motions);
    expect_tree(tree, 3);
    const TreeBone& last = tree[1].bone == 2 ? tree[1] : tree[2];
    EXPECT_EQ(tree[static_cast<std::size_t>(last.parent)].bone, far ? 1U : 0U);
  }
}

// Bones that share vertices are joined near the shared vertices.
TEST(BoneTree, PutsThePivotOfAHingeWhereBonesOverlap) {
  const Chain chain({0, 1}, 0.5, 0.0, true);
  SkinMoments moments = chain.moments();
  for (int i = 0; i < 8; ++i) {
    moments.add({10.0 + (i % 2), i % 3 - 1.0, 30}, std::vector<RigWeight>{{0, 0.5}, {1, 0.5}});
  }
  Motions motions = chain.motions;
  const auto tree = build_bone_tree(moments, kNever, motions);
  EXPECT_LT((tree[1].pivot - Vec3d(10, 0, 30)).norm(), 0.01) << tree[1].pivot;
}

TEST(BoneTree, PinsABoneAtAnExactJoint) {
  const Chain chain({0, 1, 2}, 0.5, 0.0);
  Motions motions = chain.motions;
  const auto tree = build_bone_tree(chain.moments(), 0.01, motions);
  for (std::size_t i : {1U, 2U}) {
    EXPECT_TRUE(tree[i].pinned);
    EXPECT_LT(chain.damage(tree[i].bone, motions[tree[i].bone]), 0.01);
  }
}

// The pivots of pinned bones move exactly with the parent, with the rotation that does the
// least damage; bones are pinned up to the allowed error.
TEST(BoneTree, PinsBonesWithTheLeastDamage) {
  const Chain chain({0, 1}, 0.5, 0.4);
  Motions motions = chain.motions;
  const auto tree = build_bone_tree(chain.moments(), kAlways, motions);
  expect_tree(tree, 2);
  for (const auto& bone : motions) expect_rigid(bone);
  ASSERT_TRUE(tree[1].pinned);
  EXPECT_EQ(motions[0], chain.motions[0]);
  const Vec3d& pivot = tree[1].pivot;
  for (std::size_t f = 0; f < kChainFrames; ++f) {
    EXPECT_LT((moved(motions[0][f], pivot) - moved(motions[1][f], pivot)).norm(), 1e-10);
  }
  const double damage = chain.damage(1, motions[1]);
  EXPECT_GT(damage, 0.1);
  RandomPoints random(3);
  for (int i = 0; i < 200; ++i) {
    std::vector<Motion> other = motions[1];
    for (Motion& m : other) {
      const Vec3d origin = moved(m, pivot);
      m.leftCols<3>() = turn_by((i % 2 == 0 ? 0.01 : 0.3) * random.point()) * m.leftCols<3>();
      m.col(3) = origin - m.leftCols<3>() * pivot;
    }
    EXPECT_GE(chain.damage(1, other), damage * (1.0 - 1e-9));
  }

  motions = chain.motions;
  EXPECT_TRUE(build_bone_tree(chain.moments(), 1.001 * damage, motions)[1].pinned);
  motions = chain.motions;
  EXPECT_FALSE(build_bone_tree(chain.moments(), 0.999 * damage, motions)[1].pinned);
  EXPECT_EQ(motions, chain.motions);
}

// A bone is pinned to the motion of its parent after the parent has been pinned.
TEST(BoneTree, PinsBonesToPinnedBones) {
  const Chain chain({2, 0, 3, 1}, 0.4, 0.5);
  Motions motions = chain.motions;
  const auto tree = build_bone_tree(chain.moments(), kAlways, motions);
  expect_tree(tree, 4);
  for (const auto& bone : motions) expect_rigid(bone);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_TRUE(tree[i].pinned);
    const auto& parent = motions[tree[static_cast<std::size_t>(tree[i].parent)].bone];
    for (std::size_t f = 0; f < kChainFrames; ++f) {
      EXPECT_LT(
          (moved(parent[f], tree[i].pivot) - moved(motions[tree[i].bone][f], tree[i].pivot))
              .norm(),
          1e-10);
    }
  }
}

// Bones without vertices, with one vertex or collinear vertices; bones without relative motion.
TEST(BoneTree, AcceptsDegenerateBones) {
  Chain chain({0, 1, 2, 3}, 0.5, 0.1);
  chain.rest[1].clear();
  chain.rest[2].resize(1);
  for (std::size_t v = 0; v < chain.rest[3].size(); ++v) {
    chain.rest[3][v] = Vec3d(static_cast<double>(v), 1, 1);
  }
  for (const bool still : {false, true}) {
    if (still) std::fill(chain.motions.begin(), chain.motions.end(), chain.motions[0]);
    for (const double pin_error : {0.0, kAlways}) {
      Motions motions = chain.motions;
      expect_tree(build_bone_tree(chain.moments(), pin_error, motions), 4);
      for (const auto& bone : motions) expect_rigid(bone);
      if (!still) continue;
      for (std::size_t b = 0; b < 4; ++b) EXPECT_LT(chain.damage(b, motions[b]), 1e-9) << b;
    }
  }
}

}  // namespace
}  // namespace rlpc
