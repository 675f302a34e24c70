#include "encoder/codec/kinds/skinned/fit/rig_joints.h"

#include <cstddef>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/bone_stretch.h"
#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"

namespace rlpc {
namespace {

Vec3d vec(const Point& p) { return {p[0], p[1], p[2]}; }

// Sums over the vertices of a bone and of those below it.
struct Load {
  double mass = 0.0;    // of squared weights
  double moment = 0.0;  // of squared weights times squared distances from the pivot
};

std::vector<Load> loads(const Rig& rig) {
  std::vector<Load> loads(rig.bones.size());
  for (std::size_t v = 0; v < rig.rest.size(); ++v) {
    for (const RigWeight& w : rig.weights[v]) {
      const double square = w.weight * w.weight;
      loads[w.bone].mass += square;
      loads[w.bone].moment +=
          square * (vec(rig.rest[v]) - vec(rig.bones[w.bone].pivot)).squaredNorm();
    }
  }
  for (std::size_t b = rig.bones.size(); b-- > 1;) {
    const auto parent = static_cast<std::size_t>(rig.bones[b].parent);
    const double lever2 =
        (vec(rig.bones[b].pivot) - vec(rig.bones[parent].pivot)).squaredNorm();
    loads[parent].mass += loads[b].mass;
    loads[parent].moment += loads[b].moment + loads[b].mass * lever2;
  }
  return loads;
}

Eigen::Matrix3d axes_in(const RigBone& bone, std::size_t frame) {
  return bone.axes.empty() ? rotation_matrix(bone.poses[frame].rotation)
                           : matrix_of(bone.axes[frame]);
}

}  // namespace

void fix_joints(double max_error, Rig& rig) {
  const std::vector<Load> load = loads(rig);
  for (std::size_t b = 1; b < rig.bones.size(); ++b) {
    RigBone& bone = rig.bones[b];
    const RigBone& parent = rig.bones[static_cast<std::size_t>(bone.parent)];
    double gap2 = 0.0;
    double turn2 = 0.0;
    for (std::size_t f = 0; f < bone.poses.size(); ++f) {
      const Eigen::Matrix3d above = axes_in(parent, f);
      const Vec3d expected =
          above * (vec(bone.pivot) - vec(parent.pivot)) + vec(parent.poses[f].origin);
      gap2 += (expected - vec(bone.poses[f].origin)).squaredNorm();
      turn2 += (above - axes_in(bone, f)).squaredNorm();
    }
    // A turn by a small angle displaces a point by angle * distance from the axis; the squared
    // norm of the difference of matrices is twice the squared angle.
    bone.pinned = load[b].mass * gap2 <= max_error;
    // Axes of a bone that stretches differ from those of its parent without a turn as well.
    const bool stretches = bone.stretch != Stretch::kNone;
    bone.rotates = stretches || load[b].moment * turn2 / 3.0 > max_error;
  }
}

}  // namespace rlpc
