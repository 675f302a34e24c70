// Finds bones from vertex trajectories (skinning decomposition, after Le and Deng 2012).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/bone_weights.h"
#include "encoder/codec/kinds/skinned/fit/skin_sums.h"

namespace rlpc {

// A sample of the vertices of a GOF in a sample of its frames.
struct BoneSample {
  std::size_t num_frames = 0;
  std::vector<Vec3d> positions;                       // [vertex][frame]
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;  // fixed: no index
  std::vector<std::uint32_t> place;  // [num_vertices of the GOF]: index in the sample, or kNone
  // Small patches of the mesh: a centre vertex, which comes first, and the vertices around it.
  // New bones start from patches that move rigidly.
  std::vector<std::vector<std::uint32_t>> patches;

  std::size_t num_vertices() const { return positions.size() / num_frames; }
  std::optional<std::size_t> place_of(std::uint32_t vertex) const {
    if (place[vertex] == kNone) return std::nullopt;
    return place[vertex];
  }
  std::span<const Vec3d> trajectory(std::size_t vertex) const {
    return std::span(positions).subspan(vertex * num_frames, num_frames);
  }
};

// tuned (off: 1): Rounds of each minimisation that holds one set of unknowns while it solves
// for the other: weights, rest positions, poses. Growth runs two series of such rounds,
// settling three.
inline constexpr int kRounds = 3;

// Adds bones one at a time: each takes the motion of a patch that is rigid but ill explained by
// the bones before it. Then weights and motions are improved in turn, and the least useful
// bones are exchanged for new ones. Rest positions stay those of the first frame, in which
// rigid parts are rigid, until all bones have been added.
class BoneSolver {
 public:
  // Starts with one bone. Keeps a reference to the sample.
  BoneSolver(const BoneSample& sample, std::size_t max_influences);

  // Adds bones until there are num_bones; false if none was worth adding.
  bool grow(std::size_t num_bones);
  // Tries, at most `times` times, to exchange the least useful bones for new ones; keeps what
  // lowers the error.
  void exchange_bones(int times);
  // Improves the rest positions as well; no bones can be added afterwards.
  void settle();
  bool is_settled() const { return refines_rest_; }
  // Takes the bones, weights and rest positions of a copy of this solver.
  void take(const BoneSolver& other);
  // Removes bones that save less squared error than `worth`.
  void remove_worthless_bones(double worth);

  double error() const;  // squared, over the sample
  // Returns the mean number of bones per vertex beyond the first.
  double mean_influences() const;
  // Returns the residual of bone motion, [vertex][3 * frame].
  std::vector<double> residuals() const;

  const BoneMotions& motions() const { return motions_; }
  // Returns the rest position of a vertex of the sample.
  const Vec3d& rest(std::size_t vertex) const { return rest_[vertex]; }

 private:
  // The functions below that take `sums` expect sums of the current motions and keep them up to
  // date.
  void find_patch_errors();
  bool exchange(std::size_t count, SkinSums& sums);
  std::size_t add_bones(std::size_t count, SkinSums& sums);
  std::vector<std::size_t> poorly_explained_patches(std::span<const double> error) const;
  struct PatchMotion {
    std::size_t patch = 0;
    std::vector<Motion> motion;
    std::vector<double> error;  // squared error of each vertex of the sample under this motion
  };
  std::vector<PatchMotion> patch_motions(std::span<const std::size_t> patches) const;
  struct NewBone {
    std::vector<Motion> motion;
    double saved = 0.0;  // squared error that it saves
  };
  NewBone best_new_bone(std::span<const double> error);
  std::vector<Motion> motion_of(std::span<const std::uint32_t> vertices) const;

  void improve(int rounds, SkinSums& sums);
  void improve_motions();
  void choose_candidates(std::size_t v, const SkinSums& sums);
  void fit_weights(std::size_t v, const SkinSums& sums);
  void fit_all_weights(bool new_candidates, const SkinSums& sums);
  void offer_last_bone(const SkinSums& sums);
  std::size_t farthest_candidate(std::size_t v) const;

  double loss_without(std::size_t v, std::uint32_t bone) const;
  std::vector<double> losses() const;
  void remove_bone(std::size_t bone, SkinSums& sums);

  const BoneSample& sample_;
  std::size_t max_influences_;
  double negligible_ = 0.0;  // a squared error of a vertex over all frames that is rounding
  std::vector<double> patch_error_;  // [patch], squared error if moved rigidly; lazy
  std::vector<PatchMotion> tried_;   // cached from the previous new bone: most are tried again
  bool refines_rest_ = false;
  BoneMotions motions_;
  std::vector<Vec3d> rest_;
  std::vector<BoneWeights> weights_;  // [vertex]; here `bone` is an index of motions_
  std::vector<std::vector<std::size_t>> candidates_;  // [vertex]: bones that it may follow
  std::vector<SkinSums::Gram> gram_;                  // [vertex], of its candidates
};

}  // namespace rlpc
