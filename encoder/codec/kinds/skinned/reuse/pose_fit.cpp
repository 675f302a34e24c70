#include "encoder/codec/kinds/skinned/reuse/pose_fit.h"

#include <cstddef>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/fit/bone_solver.h"
#include "encoder/codec/kinds/skinned/fit/bone_stretch.h"
#include "encoder/codec/kinds/skinned/quantise/mean_motion.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

Vec3d vertex_of(const SpanFrames& frames, std::uint32_t frame, std::uint32_t vertex) {
  const double* p = frames.at(frame, vertex);
  return {p[0], p[1], p[2]};
}

Vec3d centre_of(const SpanFrames& frames, std::uint32_t frame) {
  Vec3d sum = Vec3d::Zero();
  for (std::uint32_t v = 0; v < frames.num_vertices; ++v) sum += vertex_of(frames, frame, v);
  return sum / frames.num_vertices;
}

Vec3d point_of(const Vec3i& pivot) { return Vec3d(pivot[0], pivot[1], pivot[2]) / kPointScale; }

// Returns the pose of a bone that moves like this; of a stretched one, with the rotation that
// is nearest.
WantedPose pose_of(const Motion& motion, bool is_stretched, const Vec3d& pivot,
                   const WantedPose* before) {
  const Eigen::Matrix3d turn = motion.leftCols<3>();
  WantedPose pose;
  pose.rotation = is_stretched ? nearest_rotation(turn) : rotation_quaternion(turn);
  const Vec3d origin = moved(motion, pivot);
  for (std::size_t c = 0; c < 3; ++c) {
    pose.origin[c] = origin(static_cast<Eigen::Index>(c)) * kPointScale;
  }
  if (before == nullptr) return pose;
  double same = 0.0;
  for (std::size_t k = 0; k < 4; ++k) same += before->rotation[k] * pose.rotation[k];
  if (same < 0.0) {
    for (double& q : pose.rotation) q = -q;
  }
  return pose;
}

}  // namespace

PoseFit::PoseFit(const SharedRig& rig, const std::array<std::vector<std::int32_t>, 3>& rest)
    : rig_(rig), moments_(rig.bones.size()) {
  const std::size_t n = rig.influences.size();
  for (std::size_t v = 0; v < n; ++v) {
    rest_.push_back(Vec3d(rest[0][v], rest[1][v], rest[2][v]) / kPointScale);
    rest_centre_ += rest_.back() / static_cast<double>(n);
  }
  const double unit = exact_exp2(-rig.weight_bits);
  for (std::size_t v = 0; v < n; ++v) {
    rest_[v] -= rest_centre_;
    auto& weights = weights_.emplace_back();
    const Influence* largest = rig.influences[v].begin();
    for (const Influence& influence : rig.influences[v]) {
      weights.push_back({influence.bone, influence.weight * unit});
      if (influence.weight > largest->weight) largest = &influence;
    }
    nearest_.push_back(largest->bone);
    moments_.add(rest_[v], weights);
  }
  for (const Bone& bone : rig.bones) {
    is_free_ = is_free_ && bone.rotation_flag && bone.origin_flag;
    const bool parent_is =
        bone.parent >= 0 && is_stretched_[static_cast<std::size_t>(bone.parent)];
    is_stretched_.push_back(bone.stretch != Stretch::kNone || parent_is);
  }
  if (rig.stretch_flag) make_linear_system();
}

void PoseFit::make_linear_system() {
  constexpr std::size_t kMaxBones = 256;  // fixed: 8 MB
  constexpr double kDamping = 1e-6;       // fixed: decides only what vertices do not
  const std::size_t n = rig_.bones.size();
  if (n > kMaxBones) return;
  const std::size_t size = 4 * n;
  std::vector<double> a(size * size);
  double mean = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t k = 0; k < size; ++k) {
      a[i * size + k] = moments_.block(i / 4, k / 4)(static_cast<Eigen::Index>(i % 4),
                                                     static_cast<Eigen::Index>(k % 4));
    }
    mean += a[i * size + i] / static_cast<double>(size);
  }
  for (std::size_t i = 0; i < size; ++i) {
    damping_.push_back(kDamping * (a[i * size + i] + kDamping * mean));
    a[i * size + i] += damping_.back();
  }
  linear_.emplace(std::move(a), size);
}

// Replaces the motions of stretched bones by the linear maps that fit best, with all bones
// free.
void PoseFit::fit_linear_maps(std::span<const Motion> targets, Motions& motions) const {
  if (!linear_) return;
  std::vector<double> x(3 * damping_.size());
  for (std::size_t i = 0; i < damping_.size(); ++i) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto k = static_cast<Eigen::Index>(i % 4);
      x[3 * i + static_cast<std::size_t>(c)] =
          targets[i / 4](c, k) + damping_[i] * motions[i / 4](c, k);
    }
  }
  linear_->solve(x, 3);
  for (std::size_t i = 0; i < damping_.size(); ++i) {
    if (!is_stretched_[i / 4]) continue;
    for (Eigen::Index c = 0; c < 3; ++c) {
      motions[i / 4](c, static_cast<Eigen::Index>(i % 4)) =
          x[3 * i + static_cast<std::size_t>(c)];
    }
  }
}

// Moves each bone like the vertices that follow it most, or else like its parent.
PoseFit::Motions PoseFit::rigid_motions(const SpanFrames& frames, std::uint32_t frame,
                                        const Vec3d& centre) const {
  const std::size_t n = rig_.bones.size();
  std::vector<MotionFit> fits(n);
  std::vector<std::uint32_t> counts(n);
  for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
    fits[nearest_[v]].add(rest_[v], vertex_of(frames, frame, v) - centre);
    ++counts[nearest_[v]];
  }
  constexpr std::uint32_t kDetermined = 3;  // fixed: points that determine a rigid motion
  Motions motions;
  for (std::size_t b = 0; b < n; ++b) {
    const std::int32_t parent = rig_.bones[b].parent;
    const bool as_parent = counts[b] < kDetermined && parent >= 0;
    motions.push_back(as_parent ? motions[static_cast<std::size_t>(parent)] : fits[b].motion());
  }
  return motions;
}

// Gives each bone in turn the best motion that its flags allow. Parents come before children.
void PoseFit::keep_joints(std::span<const Motion> targets, const Vec3d& centre,
                          Motions& motions) const {
  for (std::size_t b = 0; b < motions.size(); ++b) {
    const Bone& bone = rig_.bones[b];
    const Vec3d pivot = point_of(bone.pivot) - rest_centre_;
    const Motion* parent =
        bone.parent < 0 ? nullptr : &motions[static_cast<std::size_t>(bone.parent)];
    const Vec3d carried =
        parent != nullptr ? moved(*parent, pivot) : Vec3d(pivot + rest_centre_ - centre);
    Motion rest = targets[b];  // sum of w_b r (p, 1)^T, r the residual of all other bones
    for (const std::size_t c : moments_.sharing(b)) {
      if (c != b) rest -= motions[c] * moments_.block(c, b);
    }
    const double mass = moments_.mass(b);
    const Vec3d sum = moments_.block(b, b).block<3, 1>(0, 3);  // sum of w_b^2 p
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (!bone.rotation_flag) {
      if (parent != nullptr) turn = parent->leftCols<3>();
    } else if (mass > 0.0) {
      // Rotate about the pivot if that is fixed, otherwise about the mean.
      Eigen::Matrix3d h = rest.leftCols<3>();
      if (bone.origin_flag) {
        h -= rest.col(3) * sum.transpose() / mass;
      } else {
        h -= rest.col(3) * pivot.transpose();
        h -= carried * (sum - mass * pivot).transpose();
      }
      const Eigen::Matrix3d before = motions[b].leftCols<3>();
      turn = closest_rotation(h, before);
    } else {
      turn = motions[b].leftCols<3>();
    }
    const bool is_shifted = bone.origin_flag && mass > 0.0;
    const Vec3d shift =
        is_shifted ? Vec3d((rest.col(3) - turn * sum) / mass) : Vec3d(carried - turn * pivot);
    motions[b].leftCols<3>() = turn;
    motions[b].col(3) = shift;
  }
}

// Fits consecutive frames, each starting from the one before.
void PoseFit::fit_some(const SpanFrames& frames, std::span<const std::uint32_t> chosen,
                       std::span<Motions> motions) const {
  std::vector<Vec3d> centres;
  for (const std::uint32_t f : chosen) centres.push_back(centre_of(frames, f));
  PoseTargets targets(rig_.bones.size(), chosen.size());
  std::vector<Vec3d> trajectory(chosen.size());
  for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      trajectory[i] = vertex_of(frames, chosen[i], v) - centres[i];
    }
    targets.add(rest_[v], weights_[v], trajectory);
  }
  Motions now = rigid_motions(frames, chosen.front(), centres.front());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const std::vector<Motion> wanted = targets.frame_motions(i);
    fit_poses(moments_, wanted, now);
    motions[i] = now;
    for (int k = 0; k < kRounds && !is_free_; ++k) keep_joints(wanted, centres[i], motions[i]);
    fit_linear_maps(wanted, motions[i]);
    for (Motion& m : motions[i]) m.col(3) += centres[i] - m.leftCols<3>() * rest_centre_;
  }
}

std::vector<FittedPoses> PoseFit::fit(const SpanFrames& frames,
                                      std::span<const std::uint32_t> chosen) const {
  constexpr std::size_t kTogether = 16;  // fixed: frames of a pass
  std::vector<Motions> motions(chosen.size());
  for_ranges(chosen.size(), kTogether, [&](std::size_t first, std::size_t end) {
    fit_some(frames, chosen.subspan(first, end - first),
             std::span(motions).subspan(first, end - first));
  });
  std::vector<FittedPoses> fitted(rig_.bones.size());
  for (std::size_t b = 0; b < fitted.size(); ++b) {
    const Vec3d pivot = point_of(rig_.bones[b].pivot);
    auto& [poses, axes] = fitted[b];
    for (const Motions& frame_motions : motions) {
      poses.push_back(pose_of(frame_motions[b], is_stretched_[b], pivot,
                              poses.empty() ? nullptr : &poses.back()));
      if (is_stretched_[b]) axes.push_back(images_of(frame_motions[b].leftCols<3>()));
    }
  }
  return fitted;
}

}  // namespace rlpc
