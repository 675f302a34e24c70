#include "encoder/skinned_gof/fit/bone_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "encoder/gof/lagrangian.h"
#include "encoder/parallel/for_each.h"
#include "encoder/skinned_gof/fit/bone_estimate.h"
#include "encoder/skinned_gof/fit/bone_tree.h"
#include "encoder/skinned_gof/fit/skin_sums.h"

namespace rlpc {
namespace {

// tuned (off: 0): Rounds in which weights, rest positions and poses of all vertices and frames
// are improved in turn, after those of the sample. Each takes about as long as an analysis.
constexpr int kPolish = 2;

// Bits of one influence: its weight, and the flag that it is present.
constexpr double kInfluenceBits = 7.0;  // fixed: those of the usual weight_bits, and one

// At most `most` evenly spaced frames, including the first and the last.
std::vector<std::uint32_t> sample_frames(std::uint32_t num_frames, std::uint32_t most) {
  const std::uint32_t count = std::min(num_frames, most);
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < count; ++i) {
    chosen.push_back(count == 1 ? 0
                                : static_cast<std::uint32_t>(std::uint64_t{i} *
                                                             (num_frames - 1) / (count - 1)));
  }
  return chosen;
}

std::vector<Vec3d> centres(const GofFrames& frames) {
  std::vector<Vec3d> result(frames.num_frames, Vec3d::Zero());
  for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
    for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
      const double* p = frames.at(f, v);
      result[f] += Vec3d(p[0], p[1], p[2]);
    }
    result[f] /= frames.num_vertices;
  }
  return result;
}

constexpr std::uint32_t kRings = 100;  // fixed: as kProbeVertices

using Neighbours = std::vector<std::vector<std::uint32_t>>;

Neighbours neighbours_of(std::uint32_t num_vertices, std::span<const Triangle> triangles) {
  Neighbours result(num_vertices);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      result[t[k]].push_back(t[(k + 1) % 3]);
      result[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  for (auto& n : result) {
    std::sort(n.begin(), n.end());
    n.erase(std::unique(n.begin(), n.end()), n.end());
  }
  return result;
}

// Places in the sample of a vertex and those around it, ring by ring until they are enough.
std::vector<std::uint32_t> patch_around(const Neighbours& neighbours,
                                        std::span<const std::uint32_t> place,
                                        std::uint32_t vertex) {
  // tuned (off: 1): Patches of fewer vertices than this are extended by a further ring. The
  // motion of too small a patch is not determined well enough to seed a bone.
  constexpr std::size_t kSmall = 6;
  constexpr std::size_t kLargest = 24;   // fixed: memory, where all triangles share a vertex
  constexpr std::size_t kVisited = 100;  // fixed: time, likewise
  std::vector<std::uint32_t> visited{vertex};
  std::vector<std::uint32_t> patch{place[vertex]};
  for (std::size_t first = 0; first < visited.size() && patch.size() < kSmall;) {
    const std::size_t end = visited.size();
    for (; first < end; ++first) {
      for (const std::uint32_t u : neighbours[visited[first]]) {
        if (visited.size() == kVisited || patch.size() == kLargest) return patch;
        if (std::find(visited.begin(), visited.end(), u) != visited.end()) continue;
        visited.push_back(u);
        if (place[u] != BoneSample::kNone) patch.push_back(place[u]);
      }
    }
  }
  return patch;
}

Vec3d rest_of(const Rig& rig, std::uint32_t vertex) {
  const auto& p = rig.rest[vertex];
  return {p[0], p[1], p[2]};
}

SkinMoments moments_of(const Rig& rig, std::size_t num_bones) {
  SkinMoments moments(num_bones);
  for (std::uint32_t v = 0; v < rig.rest.size(); ++v) {
    moments.add(rest_of(rig, v), rig.weights[v]);
  }
  return moments;
}

// A motion from a (part 0) to b (part 1): the rotations are blended, and the images of a point.
Motion between(const Motion& a, const Motion& b, double part, const Vec3d& point) {
  UnitQuaternion p = rotation_quaternion(a.leftCols<3>());
  const UnitQuaternion q = rotation_quaternion(b.leftCols<3>());
  double same = 0.0;
  for (std::size_t k = 0; k < 4; ++k) same += p[k] * q[k];
  const double sign = same < 0.0 ? -1.0 : 1.0;
  for (std::size_t k = 0; k < 4; ++k) p[k] = (1.0 - part) * p[k] + part * sign * q[k];
  const Vec3d image = (1.0 - part) * moved(a, point) + part * moved(b, point);
  Motion result;
  result.leftCols<3>() = rotation_matrix(normalised(p));
  result.col(3) = image - result.leftCols<3>() * point;
  return result;
}

RigBone rig_bone(const TreeBone& bone, const std::vector<Motion>& motion) {
  RigBone result;
  result.parent = bone.parent;
  result.pivot = {bone.pivot(0), bone.pivot(1), bone.pivot(2)};
  result.pinned = bone.pinned;
  for (const Motion& m : motion) {
    const Vec3d origin = moved(m, bone.pivot);
    RigPose pose{rotation_quaternion(m.leftCols<3>()), {origin(0), origin(1), origin(2)}};
    if (!result.poses.empty()) {
      const auto& before = result.poses.back().rotation;
      double same = 0.0;
      for (std::size_t k = 0; k < 4; ++k) same += before[k] * pose.rotation[k];
      if (same < 0.0) {
        for (double& q : pose.rotation) q = -q;
      }
    }
    result.poses.push_back(pose);
  }
  return result;
}

void put_in_tree_order(const std::vector<TreeBone>& tree, const BoneMotions& motions,
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

}  // namespace

BoneFit::BoneFit(const GofFrames& frames, std::span<const Triangle> triangles,
                 const BoneFitOptions& options)
    : frames_(frames),
      options_(options),
      centre_(centres(frames)),
      chosen_(sample_frames(frames.num_frames, options.sample_frames)),
      unsteady_(unsteadiness(frames)),
      sample_(std::make_shared<const BoneSample>(sample_of(triangles))),
      solver_(*sample_, options.max_influences) {}

// A position relative to the centre of all vertices in the frame.
Vec3d BoneFit::centred(std::uint32_t frame, std::uint32_t vertex) const {
  const double* p = frames_.at(frame, vertex);
  return Vec3d(p[0], p[1], p[2]) - centre_[frame];
}

void BoneFit::append_trajectory(std::uint32_t vertex, std::vector<Vec3d>& to) const {
  for (const std::uint32_t f : chosen_) to.push_back(centred(f, vertex));
}

// All vertices or, in large meshes, evenly spaced ones, and the rings of a few of them.
BoneSample BoneFit::sample_of(std::span<const Triangle> triangles) const {
  const std::uint32_t n = frames_.num_vertices;
  const std::uint32_t count = std::min(n, options_.sample_vertices);
  const std::uint32_t num_rings = std::min(count, kRings);
  const Neighbours neighbours = neighbours_of(n, triangles);
  BoneSample sample;
  sample.num_frames = chosen_.size();
  sample.place.assign(n, BoneSample::kNone);
  std::vector<std::uint32_t> vertices;
  const auto add = [&](std::uint32_t v) {
    if (sample.place[v] != BoneSample::kNone) return;
    sample.place[v] = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(v);
  };
  const auto spaced = [n](std::uint32_t i, std::uint32_t of) {
    return static_cast<std::uint32_t>(std::uint64_t{i} * n / of);
  };
  for (std::uint32_t i = 0; i < count; ++i) add(spaced(i, count));
  for (std::uint32_t i = 0; i < num_rings; ++i) {
    const std::uint32_t v = spaced(i, num_rings);
    add(v);
    for (const std::uint32_t u : neighbours[v]) add(u);
    std::vector<std::uint32_t>& ring = sample.rings.emplace_back(1, sample.place[v]);
    for (const std::uint32_t u : neighbours[v]) ring.push_back(sample.place[u]);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    sample.patches.push_back(patch_around(neighbours, sample.place, spaced(i, count)));
  }
  sample.positions.reserve(chosen_.size() * vertices.size());
  for (const std::uint32_t v : vertices) append_trajectory(v, sample.positions);
  return sample;
}

// The Lagrangian cost of the bits of one unpinned bone, as a squared error over all frames.
double BoneFit::cost_of_bone() const {
  if (options_.step == 0.0) return 0.0;  // exact fit: bones are free
  return lambda(options_.step) *
         expected_bone_bits(unsteady_, frames_, num_bones(), options_.step);
}

double BoneFit::expected_cost() const {
  const double n = static_cast<double>(frames_.num_vertices);
  return rlpc::expected_cost(*sample_, solver_.residuals(), frames_.num_vertices,
                             frames_.num_frames, options_.step) +
         static_cast<double>(num_bones()) * cost_of_bone() +
         lambda(options_.step) * kInfluenceBits * n * solver_.mean_influences();
}

double BoneFit::expected_translation_cost() const {
  std::vector<double> residuals;
  residuals.reserve(3 * sample_->positions.size());
  for (std::size_t v = 0; v < sample_->num_vertices(); ++v) {
    Vec3d mean = Vec3d::Zero();
    for (const Vec3d& x : sample_->trajectory(v)) mean += x;
    mean /= static_cast<double>(sample_->num_frames);
    for (const Vec3d& x : sample_->trajectory(v)) {
      const Vec3d residual = x - mean;
      residuals.insert(residuals.end(), {residual(0), residual(1), residual(2)});
    }
  }
  return rlpc::expected_cost(*sample_, std::move(residuals), frames_.num_vertices,
                             frames_.num_frames, options_.step);
}

double BoneFit::rms_error() const {
  return std::sqrt(solver_.error() / static_cast<double>(sample_->positions.size()));
}

double BoneFit::translation_error() const {
  double sum = 0.0;
  for (std::size_t v = 0; v < sample_->num_vertices(); ++v) {
    Vec3d mean = Vec3d::Zero();
    for (const Vec3d& x : sample_->trajectory(v)) mean += x;
    mean /= static_cast<double>(sample_->num_frames);
    for (const Vec3d& x : sample_->trajectory(v)) sum += (x - mean).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(sample_->positions.size()));
}

// Fits weights and rest positions of all vertices to the bones in some frames. rig: has the
// rest positions to start from.
void BoneFit::fit_vertices(std::span<const std::uint32_t> frames, const BoneMotions& motions,
                           std::size_t max_influences, Rig& rig) const {
  constexpr std::size_t kTogether = 64;  // fixed: memory
  const double part = static_cast<double>(frames.size()) / frames_.num_frames;
  const double per_influence = kInfluenceBits * lambda(options_.step) * part;
  const SkinSums sums_of_motions({}, motions);
  for_ranges(frames_.num_vertices, kTogether, [&](std::size_t first, std::size_t end) {
    std::vector<Vec3d> positions;
    for (std::size_t v = first; v < end; ++v) {
      for (const std::uint32_t f : frames) {
        positions.push_back(centred(f, static_cast<std::uint32_t>(v)));
      }
    }
    SkinSums sums = sums_of_motions;
    sums.set_positions(positions);
    for (std::size_t v = first; v < end; ++v) {
      const std::size_t i = v - first;
      const Point& start = rig.rest[v];
      Vec3d rest(start[0], start[1], start[2]);
      BoneWeights best;
      for (int round = 0; round < kRounds; ++round) {
        const std::vector<std::size_t> bones =
            sums.closest_bones(i, rest, SkinSums::kMaxCandidates);
        best =
            sparse_weights(sums.gram(i, bones, rest, max_influences), SkinSums::kMaxCandidates,
                           bones.size(), max_influences, per_influence);
        for (RigWeight& w : best.weights) w.bone = static_cast<std::uint32_t>(bones[w.bone]);
        rest = sums.fit_rest(i, rest, best.weights);
      }
      rig.weights[v] = std::move(best.weights);
      rig.rest[v] = {rest(0), rest(1), rest(2)};
    }
  });
}

// The rest positions of the solver where it has the vertex, else those that fit best with the
// best single bone.
void BoneFit::start_rest(const BoneSolver& solver, Rig& rig) const {
  std::vector<Vec3d> positions;
  SkinSums sums(positions, solver.motions());
  for (std::uint32_t v = 0; v < frames_.num_vertices; ++v) {
    const auto place = sample_->place_of(v);
    if (!place) {
      positions.clear();
      append_trajectory(v, positions);
      sums.set_positions(positions);
    }
    const Vec3d rest = place ? solver.rest(*place) : sums.single_rest(0);
    rig.rest[v] = {rest(0), rest(1), rest(2)};
  }
}

// Improves the motions of the bones in all frames.
void BoneFit::fit_frames(const Rig& rig, const PoseRounds& rounds, BoneMotions& motions) const {
  constexpr std::size_t kTogether = 16;  // fixed: frames to a pass of the loop
  const std::size_t n = motions.size();
  const SkinMoments moments = moments_of(rig, n);
  const std::vector<std::size_t> order = elimination_order(moments);
  for_ranges(frames_.num_frames, kTogether, [&](std::size_t first, std::size_t end) {
    PoseTargets targets(n, end - first);
    std::vector<Vec3d> trajectory(end - first);
    for (std::uint32_t v = 0; v < frames_.num_vertices; ++v) {
      for (std::size_t f = first; f < end; ++f) {
        trajectory[f - first] = centred(static_cast<std::uint32_t>(f), v);
      }
      targets.add(rest_of(rig, v), rig.weights[v], trajectory);
    }
    std::vector<Motion> now(n);
    for (std::size_t f = first; f < end; ++f) {
      const std::vector<Motion> wanted = targets.of_frame(f - first);
      for (std::size_t b = 0; b < n; ++b) now[b] = motions[b][f];
      for (int i = 0; i < rounds.single; ++i) refine_poses(moments, wanted, now);
      for (int i = 0; i < rounds.joint; ++i) solve_poses(moments, order, wanted, now);
      for (std::size_t b = 0; b < n; ++b) motions[b][f] = now[b];
    }
  });
}

// Motions in all frames, interpolated between those of the sample.
BoneMotions BoneFit::in_all_frames(const BoneMotions& motions, const Rig& rig) const {
  const SkinMoments moments = moments_of(rig, motions.size());
  BoneMotions result(motions.size(), std::vector<Motion>(frames_.num_frames));
  for (std::size_t b = 0; b < motions.size(); ++b) {
    const Vec3d centre = moments.centre(b);
    std::size_t i = 0;
    for (std::uint32_t f = 0; f < frames_.num_frames; ++f) {
      if (i + 1 < chosen_.size() && chosen_[i + 1] <= f) ++i;
      const std::size_t next = std::min(i + 1, chosen_.size() - 1);
      const double part =
          next == i ? 0.0 : static_cast<double>(f - chosen_[i]) / (chosen_[next] - chosen_[i]);
      result[b][f] = between(motions[b][i], motions[b][next], part, centre);
    }
  }
  return result;
}

Rig BoneFit::rig(std::size_t max_influences) const {
  Rig rig;
  rig.rest.resize(frames_.num_vertices);
  rig.weights.resize(frames_.num_vertices);
  BoneSolver settled = solver_;
  settled.settle();
  const double sampled = static_cast<double>(sample_->positions.size()) /
                         (static_cast<double>(frames_.num_vertices) * frames_.num_frames);
  settled.remove_worthless_bones(cost_of_bone() * sampled);
  start_rest(settled, rig);
  fit_vertices(chosen_, settled.motions(), max_influences, rig);
  BoneMotions motions = in_all_frames(settled.motions(), rig);
  fit_frames(rig, {.single = kRounds, .joint = kRounds}, motions);
  std::vector<std::uint32_t> all(frames_.num_frames);
  std::iota(all.begin(), all.end(), 0U);
  for (int i = 0; i < kPolish; ++i) {
    fit_vertices(all, motions, max_influences, rig);
    fit_frames(rig, {.joint = 2}, motions);
  }
  const SkinMoments moments = moments_of(rig, motions.size());
  for (auto& motion : motions) {
    for (std::size_t f = 0; f < motion.size(); ++f) motion[f].col(3) += centre_[f];
  }
  const double pin_error = 0.5 * cost_of_bone();  // pinning saves three of six values per pose
  const std::vector<TreeBone> tree = build_bone_tree(moments, pin_error, motions);
  put_in_tree_order(tree, motions, rig);
  return rig;
}

Point skinned_position(const Rig& rig, std::uint32_t frame, std::uint32_t vertex) {
  Vec3d sum = Vec3d::Zero();
  const Vec3d rest = rest_of(rig, vertex);
  for (const RigWeight& w : rig.weights[vertex]) {
    const RigBone& bone = rig.bones[w.bone];
    const RigPose& pose = bone.poses[frame];
    const Vec3d pivot{bone.pivot[0], bone.pivot[1], bone.pivot[2]};
    const Vec3d origin{pose.origin[0], pose.origin[1], pose.origin[2]};
    sum += w.weight * (rotation_matrix(pose.rotation) * (rest - pivot) + origin);
  }
  return {sum(0), sum(1), sum(2)};
}

}  // namespace rlpc
