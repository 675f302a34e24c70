#include "encoder/codec/kinds/skinned/fit/bone_solver.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <utility>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/fit/bone_poses.h"

namespace rlpc {
namespace {

constexpr std::size_t kVerticesTogether = 64;  // fixed: vertices or patches of a pass

}  // namespace

BoneSolver::BoneSolver(const BoneSample& sample, std::size_t max_influences)
    : sample_(sample),
      max_influences_(max_influences),
      weights_(sample.num_vertices()),
      candidates_(sample.num_vertices()),
      gram_(sample.num_vertices()) {
  Vec3d mean = Vec3d::Zero();
  const std::size_t n = sample.num_vertices();
  for (std::size_t v = 0; v < n; ++v) {
    rest_.push_back(sample.trajectory(v)[0]);
    mean += rest_.back() / static_cast<double>(n);
  }
  double extent2 = 0.0;
  for (const Vec3d& p : rest_) extent2 += (p - mean).squaredNorm() / static_cast<double>(n);
  constexpr double kNegligible = 1e-10;  // fixed: rounding
  negligible_ = kNegligible * extent2 * static_cast<double>(sample.num_frames);
  std::vector<std::uint32_t> all(n);
  std::iota(all.begin(), all.end(), 0U);
  motions_ = {motion_of(all)};
  SkinSums sums(sample.positions, motions_);
  improve(1, sums);
}

bool BoneSolver::grow(std::size_t num_bones) {
  const std::size_t before = motions_.size();
  if (before >= num_bones) return false;
  SkinSums sums(sample_.positions, motions_);
  while (motions_.size() < num_bones) {
    const std::size_t count = std::min(num_bones - motions_.size(), motions_.size());
    const std::size_t added = add_bones(count, sums);
    if (added > 0) improve(2 * kRounds, sums);
    if (added < count) break;
  }
  return motions_.size() > before;
}

void BoneSolver::exchange_bones(int times) {
  // tuned: Each exchange replaces one bone in this many. Replacing more at once is less often
  // an improvement.
  constexpr std::size_t kExchangedPart = 8;
  std::size_t count = 1 + motions_.size() / kExchangedPart;
  SkinSums sums(sample_.positions, motions_);
  for (int i = 0; i < times && count > 0; ++i) {
    if (!exchange(count, sums)) count /= 2;
  }
}

std::vector<Motion> BoneSolver::motion_of(std::span<const std::uint32_t> vertices) const {
  std::vector<Motion> motion(sample_.num_frames);
  for (std::size_t f = 0; f < sample_.num_frames; ++f) {
    MotionFit fit;
    for (const std::uint32_t v : vertices) fit.add(rest_[v], sample_.trajectory(v)[f]);
    motion[f] = f == 0 ? fit.motion() : fit.motion_near(motion[f - 1]);
  }
  return motion;
}

void BoneSolver::find_patch_errors() {
  patch_error_.assign(sample_.patches.size(), 0.0);
  for_ranges(
      sample_.patches.size(), kVerticesTogether, [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
          const std::vector<Motion> motion = motion_of(sample_.patches[i]);
          double error = 0.0;
          for (const std::uint32_t v : sample_.patches[i]) {
            for (std::size_t f = 0; f < sample_.num_frames; ++f) {
              error += (moved(motion[f], rest_[v]) - sample_.trajectory(v)[f]).squaredNorm();
            }
          }
          patch_error_[i] = error;
        }
      });
}

// Adds at most `count` bones. Returns the number added.
std::size_t BoneSolver::add_bones(std::size_t count, SkinSums& sums) {
  if (patch_error_.empty()) find_patch_errors();
  std::vector<double> error(weights_.size());
  for (std::size_t v = 0; v < error.size(); ++v) error[v] = weights_[v].error;
  std::size_t added = 0;
  for (; added < count; ++added) {
    auto [best, max_error] = best_new_bone(error);
    constexpr double kMinPart = 1e-9;  // fixed: rounding
    const double sum = std::accumulate(error.begin(), error.end(), 0.0);
    const double negligible = negligible_ * static_cast<double>(error.size());
    if (max_error <= std::max(kMinPart * sum, negligible)) break;
    motions_.push_back(std::move(best));
    sums.add_bone(motions_.back());
    offer_last_bone(sums);
    for (std::size_t v = 0; v < error.size(); ++v) error[v] = weights_[v].error;
  }
  return added;
}

// Returns disjoint patches, ordered by how much a rigid motion of their own would lower their
// error.
std::vector<std::size_t> BoneSolver::poorly_explained_patches(
    std::span<const double> error) const {
  // tuned (off: 1): Patches of vertices whose motion is tried for each new bone. The best patch
  // is seldom the one with the largest error; each one tried takes time.
  constexpr std::size_t kTried = 12;
  // tuned (off: 1e9): A patch is preferred as the seed of a bone if a rigid motion leaves at
  // most about this fraction of its error. Patches that deform make poor bones.
  constexpr double kRigid = 1e-3;
  std::vector<double> score(sample_.patches.size());
  for (std::size_t i = 0; i < score.size(); ++i) {
    const auto& patch = sample_.patches[i];
    const double total = error[patch[0]] * static_cast<double>(patch.size());
    if (total > 0.0) {
      score[i] = total * kRigid / (kRigid + patch_error_[i] / total);
    }
  }
  std::vector<std::size_t> order(score.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return score[a] > score[b]; });
  std::vector<char> touched(sample_.num_vertices(), 0);
  std::vector<std::size_t> result;
  for (const std::size_t i : order) {
    const auto& patch = sample_.patches[i];
    if (score[i] <= 0.0 || result.size() == kTried) break;
    if (touched[patch[0]] != 0) continue;
    for (const std::uint32_t v : patch) touched[v] = 1;
    result.push_back(i);
  }
  return result;
}

// Returns the rigid motions of patches. Each is refitted to all vertices of the sample that
// follow it about as closely as the patch itself.
std::vector<BoneSolver::PatchMotion> BoneSolver::patch_motions(
    std::span<const std::size_t> patches) const {
  constexpr double kClose = 2.0 * 2.0;  // fixed: up to twice as far off as the patch itself
  std::vector<PatchMotion> result;
  if (patches.empty()) return result;
  std::vector<std::vector<std::uint32_t>> cores;
  for (const std::size_t patch : patches) {
    cores.push_back(sample_.patches[patch]);
    result.push_back({patch, {}, std::vector<double>(sample_.num_vertices())});
  }
  std::vector<std::size_t> open(patches.size());  // patches whose core has changed
  std::iota(open.begin(), open.end(), std::size_t{0});
  for (int i = 0; i < kRounds && !open.empty(); ++i) {
    BoneMotions motions(open.size());
    for_each(open.size(), [&](std::size_t k) { motions[k] = motion_of(cores[open[k]]); });
    const SkinSums sums(sample_.positions, motions);
    std::vector<std::size_t> changed;
    for (std::size_t k = 0; k < open.size(); ++k) {
      const std::size_t t = open[k];
      const auto& patch = sample_.patches[patches[t]];
      const double tolerance = std::max(
          kClose * patch_error_[patches[t]] / static_cast<double>(patch.size()), negligible_);
      std::vector<std::uint32_t> close;
      for (std::uint32_t v = 0; v < sample_.num_vertices(); ++v) {
        const double alone = sums.rigid_error(v, k, rest_[v]);
        result[t].error[v] = alone;
        if (alone < tolerance) close.push_back(v);
      }
      result[t].motion = std::move(motions[k]);
      if (close.size() < cores[t].size() || close == cores[t]) continue;
      cores[t] = std::move(close);
      changed.push_back(t);
    }
    open = std::move(changed);
  }
  return result;
}

// Returns the patch motion that saves the most squared error.
BoneSolver::NewBone BoneSolver::best_new_bone(std::span<const double> error) {
  const std::vector<std::size_t> patches = poorly_explained_patches(error);
  const auto is_known = [&](std::size_t patch) {
    return std::any_of(tried_.begin(), tried_.end(),
                       [&](const PatchMotion& m) { return m.patch == patch; });
  };
  std::vector<std::size_t> others;
  std::remove_copy_if(patches.begin(), patches.end(), std::back_inserter(others), is_known);
  for (PatchMotion& m : patch_motions(others)) tried_.push_back(std::move(m));
  std::vector<PatchMotion> now;
  now.reserve(patches.size());
  for (const std::size_t patch : patches) {
    now.push_back(std::move(*std::find_if(
        tried_.begin(), tried_.end(), [&](const PatchMotion& m) { return m.patch == patch; })));
  }
  tried_ = std::move(now);
  NewBone best;
  for (const PatchMotion& m : tried_) {
    double saved = 0.0;
    for (std::size_t v = 0; v < error.size(); ++v)
      saved += std::max(error[v] - m.error[v], 0.0);
    if (saved > best.saved) best = {m.motion, saved};
  }
  return best;
}

void BoneSolver::choose_candidates(std::size_t v, const SkinSums& sums) {
  std::vector<std::size_t>& list = candidates_[v];
  list.clear();
  for (const RigWeight& w : weights_[v].weights) list.push_back(w.bone);
  for (const std::size_t bone : sums.closest_bones(v, rest_[v], SkinSums::kMaxCandidates)) {
    if (list.size() == SkinSums::kMaxCandidates) break;
    if (std::find(list.begin(), list.end(), bone) == list.end()) list.push_back(bone);
  }
}

void BoneSolver::fit_weights(std::size_t v, const SkinSums& sums) {
  gram_[v] = sums.gram(v, candidates_[v], rest_[v]);
  weights_[v] = sparse_weights(gram_[v], SkinSums::kMaxCandidates, candidates_[v].size(),
                               max_influences_, 0.0);
  for (RigWeight& w : weights_[v].weights) {
    w.bone = static_cast<std::uint32_t>(candidates_[v][w.bone]);
  }
}

void BoneSolver::fit_all_weights(bool new_candidates, const SkinSums& sums) {
  for_ranges(rest_.size(), kVerticesTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) {
      if (new_candidates) choose_candidates(v, sums);
      fit_weights(v, sums);
      if (!refines_rest_) continue;
      rest_[v] = sums.fit_rest(v, rest_[v], weights_[v].weights);
      fit_weights(v, sums);
    }
  });
}

// Fits the weights of vertices that the last bone moves more closely than a candidate.
void BoneSolver::offer_last_bone(const SkinSums& sums) {
  const std::size_t bone = motions_.size() - 1;
  for_ranges(rest_.size(), kVerticesTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) {
      std::vector<std::size_t>& list = candidates_[v];
      std::size_t place = list.size();
      if (place == SkinSums::kMaxCandidates) {
        place = farthest_candidate(v);
        const double max_error = gram_[v][place * SkinSums::kMaxCandidates + place];
        if (!(sums.rigid_error(v, bone, rest_[v]) < max_error)) continue;
        list[place] = bone;
      } else {
        list.push_back(bone);
      }
      fit_weights(v, sums);
    }
  });
}

// Returns the candidate with the largest error among those that the vertex does not follow.
std::size_t BoneSolver::farthest_candidate(std::size_t v) const {
  const std::vector<RigWeight>& weights = weights_[v].weights;
  std::size_t farthest = 0;
  double max_error = -1.0;
  for (std::size_t i = 0; i < candidates_[v].size(); ++i) {
    const double error = gram_[v][i * SkinSums::kMaxCandidates + i];
    if (error <= max_error) continue;
    const bool followed = std::any_of(weights.begin(), weights.end(), [&](const RigWeight& w) {
      return w.bone == candidates_[v][i];
    });
    if (followed) continue;
    farthest = i;
    max_error = error;
  }
  return farthest;
}

void BoneSolver::improve(int rounds, SkinSums& sums) {
  for (int i = 0; i < rounds; ++i) {
    fit_all_weights(i % kRounds == 0, sums);
    improve_motions();
    const bool only_candidates = i + 1 < rounds && (i + 1) % kRounds != 0;
    if (only_candidates) {
      sums.set_motions(motions_, candidates_);
    } else {
      sums.set_motions(motions_);
    }
  }
  fit_all_weights(false, sums);
}

void BoneSolver::settle() {
  refines_rest_ = true;
  SkinSums sums(sample_.positions, motions_);
  improve(3 * kRounds, sums);
}

void BoneSolver::improve_motions() {
  const std::size_t n = motions_.size();
  SkinMoments moments(n);
  for (std::size_t v = 0; v < rest_.size(); ++v) moments.add(rest_[v], weights_[v].weights);
  constexpr std::size_t kFrames = 16;  // fixed: frames of a pass
  for_ranges(sample_.num_frames, kFrames, [&](std::size_t first, std::size_t end) {
    PoseTargets targets(n, end - first);
    for (std::size_t v = 0; v < rest_.size(); ++v) {
      targets.add(rest_[v], weights_[v].weights,
                  sample_.trajectory(v).subspan(first, end - first));
    }
    std::vector<Motion> frame(n);
    for (std::size_t f = first; f < end; ++f) {
      const std::vector<Motion> wanted = targets.frame_motions(f - first);
      for (std::size_t b = 0; b < n; ++b) frame[b] = motions_[b][f];
      // Runs twice, as bones that share vertices follow each other.
      refine_poses(moments, wanted, frame);
      refine_poses(moments, wanted, frame);
      for (std::size_t b = 0; b < n; ++b) motions_[b][f] = frame[b];
    }
  });
}

// Returns the increase of the squared error of a vertex if it can no longer follow a bone.
double BoneSolver::loss_without(std::size_t v, std::uint32_t bone) const {
  const std::size_t count = candidates_[v].size();
  if (count < 2) return 0.0;
  // Remove the bone from the Gram matrix: the last candidate takes its row and column.
  SkinSums::Gram gram = gram_[v];
  const auto at = std::find(candidates_[v].begin(), candidates_[v].end(), bone);
  const auto gone = static_cast<std::size_t>(at - candidates_[v].begin());
  constexpr std::size_t kStride = SkinSums::kMaxCandidates;
  for (std::size_t i = 0; i < count; ++i) {
    gram[gone * kStride + i] = gram[(count - 1) * kStride + i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    gram[i * kStride + gone] = gram[i * kStride + count - 1];
  }
  const double without = sparse_weights(gram, kStride, count - 1, max_influences_, 0.0).error;
  return std::max(without - weights_[v].error, 0.0);
}

// Returns [bone]: the increase of the squared error if the bone is removed.
std::vector<double> BoneSolver::losses() const {
  std::vector<std::array<double, kMaxExtraBones>> vertex_losses(rest_.size());
  for_ranges(rest_.size(), kVerticesTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) {
      const std::vector<RigWeight>& weights = weights_[v].weights;
      for (std::size_t i = 0; i < weights.size(); ++i) {
        vertex_losses[v][i] = loss_without(v, weights[i].bone);
      }
    }
  });
  std::vector<double> loss(motions_.size(), 0.0);
  for (std::size_t v = 0; v < rest_.size(); ++v) {
    const std::vector<RigWeight>& weights = weights_[v].weights;
    for (std::size_t i = 0; i < weights.size(); ++i)
      loss[weights[i].bone] += vertex_losses[v][i];
  }
  return loss;
}

void BoneSolver::remove_bone(std::size_t bone, SkinSums& sums) {
  motions_.erase(motions_.begin() + static_cast<std::ptrdiff_t>(bone));
  sums.remove_bone(bone);
  for_ranges(rest_.size(), kVerticesTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) {
      bool lost = false;
      for (std::size_t& candidate : candidates_[v]) {
        lost = lost || candidate == bone;
        if (candidate > bone) --candidate;
      }
      if (lost) {
        weights_[v].weights.clear();
        choose_candidates(v, sums);
        fit_weights(v, sums);
      } else {
        for (RigWeight& w : weights_[v].weights) {
          if (w.bone > bone) --w.bone;
        }
      }
    }
  });
}

double BoneSolver::error() const {
  double sum = 0.0;
  for (const BoneWeights& w : weights_) sum += w.error;
  return sum;
}

double BoneSolver::mean_influences() const {
  std::size_t sum = 0;
  for (const BoneWeights& w : weights_) sum += w.weights.size() - 1;
  return static_cast<double>(sum) / static_cast<double>(weights_.size());
}

std::vector<double> BoneSolver::residuals() const {
  std::vector<double> result;
  result.reserve(3 * sample_.positions.size());
  for (std::size_t v = 0; v < rest_.size(); ++v) {
    for (std::size_t f = 0; f < sample_.num_frames; ++f) {
      Vec3d residual = sample_.trajectory(v)[f];
      for (const RigWeight& w : weights_[v].weights) {
        residual -= w.weight * moved(motions_[w.bone][f], rest_[v]);
      }
      result.insert(result.end(), {residual(0), residual(1), residual(2)});
    }
  }
  return result;
}

// Replaces the `count` least useful bones by new ones. Undoes that and returns false if it does
// not lower the error.
bool BoneSolver::exchange(std::size_t count, SkinSums& sums) {
  const BoneSolver before = *this;
  SkinSums sums_before = sums;
  for (std::size_t i = 0; i < count && motions_.size() > 1; ++i) {
    const std::vector<double> loss = losses();
    remove_bone(
        static_cast<std::size_t>(std::min_element(loss.begin(), loss.end()) - loss.begin()),
        sums);
  }
  add_bones(before.motions_.size() - motions_.size(), sums);
  improve(2 * kRounds, sums);
  if (error() < before.error()) return true;
  take(before);
  sums = std::move(sums_before);
  return false;
}

void BoneSolver::take(const BoneSolver& other) {
  motions_ = other.motions_;
  rest_ = other.rest_;
  weights_ = other.weights_;
  candidates_ = other.candidates_;
  gram_ = other.gram_;
}

void BoneSolver::remove_worthless_bones(double worth) {
  std::optional<SkinSums> sums;  // made once a bone is removed
  while (motions_.size() > 1) {
    const std::vector<double> loss = losses();
    const auto min = std::min_element(loss.begin(), loss.end());
    if (*min >= worth) break;
    if (!sums) sums.emplace(sample_.positions, motions_);
    remove_bone(static_cast<std::size_t>(min - loss.begin()), *sums);
  }
  if (sums) improve(2 * kRounds, *sums);
}

}  // namespace rlpc
