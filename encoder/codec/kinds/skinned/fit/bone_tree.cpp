#include "encoder/codec/kinds/skinned/fit/bone_tree.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

using Motions = std::vector<Motion>;  // one per frame

struct Joint {
  Vec3d pivot = Vec3d::Zero();
  double cost = 0.0;  // summed over frames: squared gap at the pivot, and relative rotation
};

// Returns the point that two bones move most alike. If that is ambiguous, as along the axis of
// a hinge, the point nearest to `expected`.
Vec3d common_point(const Motions& parent, const Motions& child, const Vec3d& expected) {
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  Vec3d g = Vec3d::Zero();  // relative to the expected point
  for (std::size_t f = 0; f < child.size(); ++f) {
    const Motion gap = parent[f] - child[f];
    h += gap.leftCols<3>().transpose() * gap.leftCols<3>();
    g -= gap.leftCols<3>().transpose() * moved(gap, expected);
  }
  constexpr double kPull = 1e-5;   // fixed: where frames leave a choice
  constexpr double kStill = 1e-8;  // fixed: bones that turn less together share all points
  const double pull = kPull * h.trace() + kStill * static_cast<double>(child.size());
  h += pull * Eigen::Matrix3d::Identity();
  std::vector<double> x(g.data(), g.data() + 3);
  SymmetricSystem({h.data(), h.data() + 9}, 3).solve(x);
  return expected + Vec3d(x[0], x[1], x[2]);
}

Joint joint_between(const SkinMoments& moments, const std::vector<Motions>& motions,
                    std::size_t parent, std::size_t child) {
  const Eigen::Matrix4d& overlap = moments.block(parent, child);
  constexpr double kOverlap = 1e-3;  // fixed: weights that count
  const Vec3d expected = overlap(3, 3) > kOverlap
                             ? Vec3d(overlap.block<3, 1>(0, 3) / overlap(3, 3))
                             : moments.centre(child);
  Joint joint;
  joint.pivot = common_point(motions[parent], motions[child], expected);
  const double lever2 = moments.spread2(child);
  Eigen::Matrix3d before = Eigen::Matrix3d::Zero();
  for (std::size_t f = 0; f < motions[child].size(); ++f) {
    const Motion& a = motions[parent][f];
    const Motion& b = motions[child][f];
    const Eigen::Matrix3d relative = a.leftCols<3>().transpose() * b.leftCols<3>();
    joint.cost += (moved(a, joint.pivot) - moved(b, joint.pivot)).squaredNorm();
    if (f > 0) joint.cost += lever2 * (relative - before).squaredNorm();
    before = relative;
  }
  return joint;
}

// Pins a bone: moves its pivot with the parent and chooses the rotation that displaces the
// vertices least. Returns the sum of w^2 times the squared displacement of the vertices of the
// bone.
double pin(const Eigen::Matrix4d& moments, const Vec3d& pivot, const Motions& parent,
           Motions& motions) {
  const Vec3d sum = moments.block<3, 1>(0, 3) - moments(3, 3) * pivot;  // w^2 (p - pivot)
  const Eigen::Matrix3d products =
      moments.block<3, 3>(0, 0) - moments.block<3, 1>(0, 3) * pivot.transpose() -
      pivot * moments.block<3, 1>(0, 3).transpose() + moments(3, 3) * pivot * pivot.transpose();
  double damage = 0.0;
  for (std::size_t f = 0; f < motions.size(); ++f) {
    const Vec3d origin = moved(parent[f], pivot);
    const Vec3d gap = moved(motions[f], pivot) - origin;
    const Eigen::Matrix3d free = motions[f].leftCols<3>();
    const Eigen::Matrix3d h = free * products + gap * sum.transpose();
    const Eigen::Matrix3d r = rotation_matrix(nearest_rotation(h));
    const Eigen::Matrix3d turn = free - r;
    damage += (turn * products * turn.transpose()).trace() + 2.0 * gap.dot(turn * sum) +
              moments(3, 3) * gap.squaredNorm();
    motions[f].leftCols<3>() = r;
    motions[f].col(3) = origin - r * pivot;
  }
  return damage;
}

RigBone rig_bone(const TreeBone& bone, const Motions& motion) {
  RigBone result;
  result.parent = bone.parent;
  result.pivot = {bone.pivot(0), bone.pivot(1), bone.pivot(2)};
  result.pinned = bone.pinned;
  for (const Motion& m : motion) {
    const Vec3d origin = moved(m, bone.pivot);
    RigPose pose{rotation_quaternion(m.leftCols<3>()), {origin(0), origin(1), origin(2)}};
    if (!result.poses.empty()) keep_sign(result.poses.back().rotation, pose.rotation);
    result.poses.push_back(pose);
  }
  return result;
}

}  // namespace

std::vector<TreeBone> build_bone_tree(const SkinMoments& moments, double pin_error,
                                      std::vector<Motions>& motions) {
  const std::size_t n = moments.num_bones();
  std::size_t root = 0;
  for (std::size_t b = 1; b < n; ++b) {
    if (moments.mass(b) > moments.mass(root)) root = b;
  }
  std::vector<TreeBone> tree{{root, -1, moments.centre(root), false}};
  std::vector<TreeBone> nearest(n);  // [bone], best place in the tree so far
  std::vector<double> cost(n, std::numeric_limits<double>::infinity());
  std::vector<char> outside(n, 1);
  outside[root] = 0;
  while (tree.size() < n) {
    const std::size_t newest = tree.size() - 1;
    std::size_t next = n;
    for (std::size_t b = 0; b < n; ++b) {
      if (outside[b] == 0) continue;
      const Joint joint = joint_between(moments, motions, tree[newest].bone, b);
      if (joint.cost < cost[b]) {
        cost[b] = joint.cost;
        nearest[b] = {b, static_cast<int>(newest), joint.pivot, false};
      }
      if (next == n || cost[b] < cost[next]) next = b;
    }
    outside[next] = 0;
    tree.push_back(nearest[next]);
  }
  for (std::size_t i = 1; i < n; ++i) {
    TreeBone& child = tree[i];
    const std::size_t parent = tree[static_cast<std::size_t>(child.parent)].bone;
    Motions pinned = motions[child.bone];
    const double damage =
        pin(moments.block(child.bone, child.bone), child.pivot, motions[parent], pinned);
    if (damage > pin_error) continue;
    child.pinned = true;
    motions[child.bone] = std::move(pinned);
  }
  return tree;
}

void put_in_tree(const std::vector<TreeBone>& tree, const std::vector<Motions>& motions,
                 Rig& rig) {
  std::vector<std::uint32_t> place(tree.size());
  for (std::size_t i = 0; i < tree.size(); ++i) {
    place[tree[i].bone] = static_cast<std::uint32_t>(i);
    rig.bones.push_back(rig_bone(tree[i], motions[tree[i].bone]));
  }
  for (auto& weights : rig.weights) {
    for (RigWeight& w : weights) w.bone = place[w.bone];
  }
}

}  // namespace rlpc
