// Fits a skinned mesh to the frames of a GOF: rigid bones, and vertices that follow a few of
// them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/kinds/skinned/fit/bone_estimate.h"
#include "encoder/codec/kinds/skinned/fit/bone_poses.h"
#include "encoder/codec/kinds/skinned/fit/bone_solver.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/codec/spans/sample_size.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

struct BoneFitOptions {
  std::size_t max_influences = 3;  // maximum bones per vertex during the search, 1 to 4
  std::uint32_t sample_frames = kSampleFrames;
  std::uint32_t sample_vertices = kSampleVertices;
  int exchanges = kExchanges;  // maximum attempts to exchange bones per call of settle()

  // tuned (off: 0): Rounds in which the least useful bones are exchanged for new ones, once all
  // bones are found. They lead out of local minima, and take most of the time of a fit.
  static constexpr int kExchanges = 2;
};

// Finds bones, weights, rest positions, hierarchy and pivots, for a growing number of bones.
// Time is linear in vertices and frames.
class BoneFit {
 public:
  // Keeps a reference to the frames: at least one, with at least one vertex.
  BoneFit(const SpanFrames& frames, std::span<const Triangle> triangles,
          const BoneFitOptions& options);
  BoneFit(const BoneFit&) = delete;
  BoneFit& operator=(const BoneFit&) = delete;

  // Adds bones until there are num_bones; false if none was worth adding.
  bool grow(std::size_t num_bones) { return solver_.grow(num_bones); }
  // Replaces bones by more useful ones. Takes about as long as grow().
  void settle() { solver_.exchange_bones(options_.exchanges); }
  // Returns a copy of the bones for return_to().
  BoneSolver state() const { return solver_; }
  void return_to(const BoneSolver& state) { solver_.take(state); }
  // Return the residuals of the bones of a state, for expected_cost(); and of a single bone
  // that only translates, with the centre of the vertices.
  ResidualSpectrum spectrum(const BoneSolver& state) const;
  ResidualSpectrum translation_spectrum() const;
  // Returns the expected Lagrangian cost of the GOF with the bones of a state, without rest
  // positions (bone_estimate.h). step: quantiser step, grid units.
  double expected_cost(const BoneSolver& state, const ResidualSpectrum& spectrum,
                       double step) const;
  // Returns about the sum of squared distances of all vertices from the centres of their
  // frames.
  double squared_spread() const;
  // Returns the RMS error of a vertex position in the sample, grid units.
  double rms_error() const;
  std::size_t num_bones() const { return solver_.motions().size(); }

  // Returns the rig of all frames, without bones that save less than they cost. Bone 0 is the
  // only root. The weights of a vertex are in descending order; quaternions keep their sign
  // from frame to frame.
  //
  //   max_influences  maximum bones per vertex, 1 to 4
  //   step            quantiser step, grid units; 0: fit as precisely as possible
  Rig rig(const BoneSolver& state, std::size_t max_influences, double step) const;

 private:
  double cost_of_bone(std::size_t num_bones, double step) const;
  Vec3d centred(std::uint32_t frame, std::uint32_t vertex) const;
  void append_trajectory(std::uint32_t vertex, std::vector<Vec3d>& to) const;
  BoneSample sample_of(std::span<const Triangle> triangles) const;
  void fit_vertices(const BoneSolver& solver, std::size_t max_influences, double step,
                    Rig& rig) const;
  BoneMotions fit_frames(const BoneMotions& motions, const SkinMoments& moments,
                         const Rig& rig) const;

  const SpanFrames& frames_;
  BoneFitOptions options_;
  std::vector<Vec3d> centre_;  // [num_frames], mean vertex; the sample is relative to it
  std::vector<std::uint32_t> chosen_;  // the frames of the sample
  std::vector<double> unsteady_;       // unsteadiness() of the frames
  BoneSample sample_;
  BoneSolver solver_;
};

// The position of a vertex in a frame, grid units: sum_b w_b (R_b(f) (p - c_b) + o_b(f)), with
// rest position p, pivot c_b, and the rotation R_b and origin o_b of the pose.
Point skinned_position(const Rig& rig, std::uint32_t frame, std::uint32_t vertex);

}  // namespace rlpc
