// Finds bones from trajectories (skinning decomposition; after Le and Deng 2012).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "encoder/skinned_gof/fit/bone_weights.h"
#include "encoder/skinned_gof/fit/skin_sums.h"

namespace rlpc {

// Some vertices in some frames.
struct BoneSample {
  std::size_t num_frames = 0;
  std::vector<Vec3d> positions;                       // [vertex][frame]
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;  // fixed: no index
  std::vector<std::uint32_t> place;  // [num_vertices of the GOF] in the sample, or kNone
  // Small patches, each the vertices around one: bones are looked for where one moves rigidly.
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

// Bones come in one at a time: each takes the motion of a patch that is rigid but ill explained
// by the bones before it. Then weights and motions are improved in turn, and the bones that are
// missed least are exchanged for new ones. Rest positions stay those of the first frame, in
// which rigid parts are rigid, until all bones are there.
class BoneSolver {
 public:
  // The sample is kept by reference. There is one bone at first.
  BoneSolver(const BoneSample& sample, std::size_t max_influences);

  // Adds bones up to a number, in several steps; false if none was worth adding.
  bool grow(std::size_t num_bones);
  // Exchanges the bones that are missed least for new ones, as often as that is better.
  void exchange_bones(int times);
  // Improves rest positions, too; bones cannot be added after that.
  void settle();
  // Leaves out bones that save less squared error than `worth`.
  void remove_worthless_bones(double worth);

  double error() const;  // squared, over the sample
  double mean_influences() const;
  // What the bones leave: [vertex][3 * frame].
  std::vector<double> residuals() const;

  const BoneMotions& motions() const { return motions_; }
  const Vec3d& rest(std::size_t vertex) const { return rest_[vertex]; }  // of the sample

 private:
  // `sums` are those of the motions, before and after.
  void find_patch_errors();
  bool exchange(std::size_t count, SkinSums& sums);
  void take(const BoneSolver& other);
  std::size_t add_bones(std::size_t count, SkinSums& sums);
  std::vector<std::size_t> ill_explained_patches(std::span<const double> error) const;
  struct PatchMotion {
    std::size_t patch = 0;
    std::vector<Motion> motion;
    std::vector<double> error;  // of each vertex of the sample if it moves so
  };
  std::vector<PatchMotion> patch_motions(std::span<const std::size_t> patches) const;
  struct NewBone {
    std::vector<Motion> motion;
    double saved = 0.0;  // squared error
  };
  NewBone best_new_bone(std::span<const double> error);
  std::vector<Motion> motion_of(std::span<const std::uint32_t> vertices) const;

  void improve(int rounds, SkinSums& sums);
  void improve_motions();
  void choose_candidates(const SkinSums& sums);
  void fit_all_weights(bool new_candidates, const SkinSums& sums);

  std::vector<double> missed() const;
  void remove_bone(std::size_t bone, SkinSums& sums);

  const BoneSample& sample_;
  std::size_t max_influences_;
  double negligible_ = 0.0;          // squared error of a vertex over the frames
  std::vector<double> patch_error_;  // when moved rigidly; once needed
  std::vector<PatchMotion> tried_;   // when a bone was added last: most are tried again
  bool rests_move_ = false;
  BoneMotions motions_;
  std::vector<Vec3d> rest_;
  std::vector<BoneWeights> weights_;  // of bones
  std::vector<std::vector<std::size_t>> candidates_;
  std::vector<SkinSums::Gram> gram_;  // of the candidates
};

}  // namespace rlpc
