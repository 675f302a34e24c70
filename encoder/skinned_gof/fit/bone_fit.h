// A group of frames as a skinned mesh: bones that move rigidly, and vertices that follow a few.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mesh.h"
#include "encoder/gof/gof_frames.h"
#include "encoder/skinned_gof/fit/bone_poses.h"
#include "encoder/skinned_gof/fit/bone_solver.h"
#include "encoder/skinned_gof/fit/rig.h"

namespace rlpc {

struct BoneFitOptions {
  std::size_t max_influences = 3;  // of a vertex while bones are looked for, 1 to 4
  double step = 1.0;  // of the quantisers, grid units: smaller errors do not matter
  std::uint32_t sample_frames = kSampleFrames;
  std::uint32_t sample_vertices = kSampleVertices;
  int exchanges = kExchanges;  // of bones, each time these settle

  static constexpr std::uint32_t kSampleFrames = 64;  // tuned: at most so many are looked at
  static constexpr std::uint32_t kSampleVertices = 3000;  // tuned: of so many vertices
  static constexpr int kExchanges = 6;                    // tuned (off: 0): of bones
};

// Finds bones, weights, rest positions, tree and pivots of at least one vertex in at least one
// frame, for a growing number of bones. Time is linear in vertices and frames.
class BoneFit {
 public:
  // The frames are kept by reference.
  BoneFit(const GofFrames& frames, std::span<const Triangle> triangles,
          const BoneFitOptions& options);
  BoneFit(const BoneFit&) = delete;
  BoneFit& operator=(const BoneFit&) = delete;

  // Adds bones up to a number; false if none was worth adding.
  bool grow(std::size_t num_bones) { return solver_.grow(num_bones); }
  // Puts bones where these serve better. That takes about as long as growing.
  void settle() { solver_.exchange_bones(options_.exchanges); }
  // What coding the GOF with these bones is expected to cost (bone_estimate.h), rest positions
  // left out; and with one that only follows the centre of the vertices.
  double expected_cost() const;
  double expected_translation_cost() const;
  // Of a vertex of the sample in a frame, grid units.
  double rms_error() const;
  // The same of one bone that only follows the centre of the vertices.
  double translation_error() const;
  std::size_t num_bones() const { return solver_.motions().size(); }

  // The bones that save more bits than they cost. Bone 0 is the only root; weights are heaviest
  // first; rotations do not change sign from frame to frame.
  // max_influences: of a vertex, 1 to 4.
  Rig rig(std::size_t max_influences) const;

 private:
  double cost_of_bone() const;
  Vec3d centred(std::uint32_t frame, std::uint32_t vertex) const;
  void append_trajectory(std::uint32_t vertex, std::vector<Vec3d>& to) const;
  BoneSample sample_of(std::span<const Triangle> triangles) const;
  void fit_vertices(const BoneSolver& solver, std::size_t max_influences, Rig& rig) const;
  BoneMotions fit_frames(const BoneMotions& motions, const SkinMoments& moments,
                         const Rig& rig) const;

  const GofFrames& frames_;
  BoneFitOptions options_;
  std::vector<Vec3d> centre_;          // [num_frames]: everything is relative to it
  std::vector<std::uint32_t> chosen_;  // frames that are looked at together
  std::vector<double> unsteady_;       // bone_estimate.h
  BoneSample sample_;
  BoneSolver solver_;
};

// sum_b w_b (R_b(f) (p - c_b) + o_b(f))
Point skinned_position(const Rig& rig, std::uint32_t frame, std::uint32_t vertex);

}  // namespace rlpc
