#include "encoder/codec/kinds/skinned/fit/bone_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/fit/bone_estimate.h"
#include "encoder/codec/kinds/skinned/fit/bone_stretch.h"
#include "encoder/codec/kinds/skinned/fit/bone_tree.h"
#include "encoder/codec/kinds/skinned/fit/skin_sums.h"
#include "encoder/codec/kinds/skinned/fit/vertex_rings.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// Bits of one influence: its weight, and the flag that it is present.
constexpr double kInfluenceBits = 7.0;  // fixed: the usual weight_bits, and one

// Returns at most `max` evenly spaced frames, including the first and the last.
std::vector<std::uint32_t> sample_frames(std::uint32_t num_frames, std::uint32_t max) {
  const std::uint32_t count = std::min(num_frames, max);
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < count; ++i) {
    chosen.push_back(count == 1 ? 0
                                : static_cast<std::uint32_t>(std::uint64_t{i} *
                                                             (num_frames - 1) / (count - 1)));
  }
  return chosen;
}

std::vector<Vec3d> centres(const SpanFrames& frames) {
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

// Returns a vertex, then its neighbours, then their neighbours if the first ring is small.
std::vector<std::uint32_t> patch_around(const VertexRings& neighbours, std::uint32_t vertex) {
  // tuned (off: 1): Patches of fewer vertices than this are extended by a second ring. The
  // motion of too small a patch is not determined well enough to seed a bone.
  constexpr std::size_t kSmall = 6;
  constexpr std::size_t kLargest = 24;  // fixed: memory, where all triangles share a vertex
  std::vector<std::uint32_t> patch{vertex};
  const auto add = [&](std::uint32_t v) {
    if (patch.size() < kLargest && std::find(patch.begin(), patch.end(), v) == patch.end()) {
      patch.push_back(v);
    }
  };
  for (const std::uint32_t v : neighbours[vertex]) add(v);
  if (patch.size() >= kSmall) return patch;
  for (const std::uint32_t v : neighbours[vertex]) {
    for (const std::uint32_t u : neighbours[v]) add(u);
  }
  return patch;
}

Vec3d rest_of(const Rig& rig, std::uint32_t vertex) {
  const auto& p = rig.rest[vertex];
  return {p[0], p[1], p[2]};
}

}  // namespace

BoneFit::BoneFit(const SpanFrames& frames, std::span<const Triangle> triangles,
                 const BoneFitOptions& options)
    : frames_(frames),
      options_(options),
      centre_(centres(frames)),
      chosen_(sample_frames(frames.num_frames, options.sample_frames)),
      unsteady_(unsteadiness(frames)),
      sample_(sample_of(triangles)),
      solver_(sample_, options.max_influences) {}

// Returns a position relative to the centre of all vertices in the frame.
Vec3d BoneFit::centred(std::uint32_t frame, std::uint32_t vertex) const {
  const double* p = frames_.at(frame, vertex);
  return Vec3d(p[0], p[1], p[2]) - centre_[frame];
}

void BoneFit::append_trajectory(std::uint32_t vertex, std::vector<Vec3d>& to) const {
  for (const std::uint32_t f : chosen_) to.push_back(centred(f, vertex));
}

// Samples all vertices or, in large meshes, the patches around evenly spaced vertices.
BoneSample BoneFit::sample_of(std::span<const Triangle> triangles) const {
  constexpr std::uint32_t kPatchSize = 7;  // fixed: vertices of a regular one
  const std::uint32_t n = frames_.num_vertices;
  const std::uint32_t seeds =
      n <= options_.sample_vertices ? n : options_.sample_vertices / kPatchSize;
  const VertexRings neighbours = vertex_rings(n, triangles);
  BoneSample sample;
  sample.num_frames = chosen_.size();
  sample.positions.reserve(chosen_.size() * std::min(n, options_.sample_vertices));
  std::vector<std::uint32_t>& index = sample.place;
  index.assign(n, BoneSample::kNone);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < seeds; ++i) {
    const auto seed = static_cast<std::uint32_t>(std::uint64_t{i} * n / seeds);
    std::vector<std::uint32_t> patch = patch_around(neighbours, seed);
    for (std::uint32_t& v : patch) {
      if (index[v] == BoneSample::kNone) {
        index[v] = count++;
        append_trajectory(v, sample.positions);
      }
      v = index[v];
    }
    sample.patches.push_back(std::move(patch));
  }
  return sample;
}

// Returns the Lagrangian cost of the bits of one unpinned bone, as a squared error over all
// frames.
double BoneFit::cost_of_bone(std::size_t num_bones, double step) const {
  if (step == 0.0) return 0.0;  // exact fit: bones are free
  return lambda(step) * expected_bone_bits(unsteady_, frames_, num_bones, step);
}

double BoneFit::expected_cost(const BoneSolver& state, const ResidualSpectrum& spectrum,
                              double step) const {
  const std::size_t num_bones = state.motions().size();
  return rlpc::expected_cost(spectrum, frames_.num_vertices, frames_.num_frames, step) +
         static_cast<double>(num_bones) * cost_of_bone(num_bones, step) +
         lambda(step) * kInfluenceBits * frames_.num_vertices * state.mean_influences();
}

ResidualSpectrum BoneFit::spectrum(const BoneSolver& state) const {
  return residual_spectrum(sample_, state.residuals(), frames_.num_vertices,
                           frames_.num_frames);
}

ResidualSpectrum BoneFit::translation_spectrum() const {
  std::vector<double> residuals;
  residuals.reserve(3 * sample_.positions.size());
  for (std::size_t v = 0; v < sample_.num_vertices(); ++v) {
    Vec3d mean = Vec3d::Zero();
    for (const Vec3d& x : sample_.trajectory(v)) mean += x;
    mean /= static_cast<double>(sample_.num_frames);
    for (const Vec3d& x : sample_.trajectory(v)) {
      const Vec3d residual = x - mean;
      residuals.insert(residuals.end(), {residual(0), residual(1), residual(2)});
    }
  }
  return residual_spectrum(sample_, std::move(residuals), frames_.num_vertices,
                           frames_.num_frames);
}

double BoneFit::squared_spread() const {
  double sum = 0.0;
  for (const Vec3d& x : sample_.positions) sum += x.squaredNorm();
  return sum / static_cast<double>(sample_.positions.size()) * frames_.num_vertices *
         frames_.num_frames;
}

double BoneFit::rms_error() const {
  return std::sqrt(solver_.error() / static_cast<double>(sample_.positions.size()));
}

// Fits weights and rest positions of all vertices to the bones.
void BoneFit::fit_vertices(const BoneSolver& solver, std::size_t max_influences, double step,
                           Rig& rig) const {
  constexpr std::size_t kTogether = 64;  // fixed: vertices of a pass
  const double part = static_cast<double>(chosen_.size()) / frames_.num_frames;
  const double per_influence = kInfluenceBits * lambda(step) * part;
  const SkinSums sums_of_motions({}, solver.motions());
  for_ranges(frames_.num_vertices, kTogether, [&](std::size_t first, std::size_t end) {
    std::vector<Vec3d> positions;
    for (std::size_t v = first; v < end; ++v) {
      append_trajectory(static_cast<std::uint32_t>(v), positions);
    }
    SkinSums sums = sums_of_motions;
    sums.set_positions(positions);
    for (std::size_t v = first; v < end; ++v) {
      const std::size_t i = v - first;
      const auto place = sample_.place_of(static_cast<std::uint32_t>(v));
      Vec3d rest = place ? solver.rest(*place) : sums.single_rest(i);
      BoneWeights best;
      for (int round = 0; round < kRounds; ++round) {
        const std::vector<std::size_t> bones =
            sums.closest_bones(i, rest, SkinSums::kMaxCandidates);
        best = sparse_weights(sums.gram(i, bones, rest), SkinSums::kMaxCandidates, bones.size(),
                              max_influences, per_influence);
        for (RigWeight& w : best.weights) w.bone = static_cast<std::uint32_t>(bones[w.bone]);
        rest = sums.fit_rest(i, rest, best.weights);
      }
      rig.weights[v] = std::move(best.weights);
      rig.rest[v] = {rest(0), rest(1), rest(2)};
    }
  });
}

// Fits the bone motions of all frames. Each frame starts from the motions in the frame before
// or, if it is in the sample, from those found there.
BoneMotions BoneFit::fit_frames(const BoneMotions& motions, const SkinMoments& moments,
                                const Rig& rig) const {
  constexpr std::size_t kTogether = 16;  // fixed: frames of a pass
  const std::size_t n = motions.size();
  BoneMotions result(n, std::vector<Motion>(frames_.num_frames));
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
    std::size_t nearest = 0;
    for (std::size_t f = first; f < end; ++f) {
      const std::vector<Motion> wanted = targets.frame_motions(f - first);
      bool starts = f == first;
      while (nearest + 1 < chosen_.size() && chosen_[nearest + 1] <= f) {
        ++nearest;
        starts = true;
      }
      if (starts) {
        for (std::size_t b = 0; b < n; ++b) now[b] = motions[b][nearest];
      }
      fit_poses(moments, wanted, now);
      for (std::size_t b = 0; b < n; ++b) {
        result[b][f] = now[b];
        result[b][f].col(3) += centre_[f];
      }
    }
  });
  return result;
}

Rig BoneFit::rig(const BoneSolver& state, std::size_t max_influences, double step) const {
  Rig rig;
  rig.rest.resize(frames_.num_vertices);
  rig.weights.resize(frames_.num_vertices);
  BoneSolver settled = state;
  if (!settled.is_settled()) settled.settle();
  const double sampled = static_cast<double>(sample_.positions.size()) /
                         (static_cast<double>(frames_.num_vertices) * frames_.num_frames);
  const double worth = cost_of_bone(state.motions().size(), step);
  settled.remove_worthless_bones(worth * sampled);
  fit_vertices(settled, max_influences, step, rig);
  SkinMoments moments(settled.motions().size());
  for (std::uint32_t v = 0; v < frames_.num_vertices; ++v) {
    moments.add(rest_of(rig, v), rig.weights[v]);
  }
  BoneMotions motions = fit_frames(settled.motions(), moments, rig);
  const double pin_error = 0.5 * worth;  // pinning saves three of six values per pose
  const std::vector<TreeBone> tree = build_bone_tree(moments, pin_error, motions);
  put_in_tree(tree, motions, rig);
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
    const Eigen::Matrix3d axes =
        bone.axes.empty() ? rotation_matrix(pose.rotation) : matrix_of(bone.axes[frame]);
    sum += w.weight * (axes * (rest - pivot) + origin);
  }
  return {sum(0), sum(1), sum(2)};
}

}  // namespace rlpc
