// The spatial factors of a shared rig as decoded, and the best temporal values for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/codec/kinds/skinned/quantise/kept_rig.h"
#include "encoder/codec/kinds/skinned/quantise/mean_motion.h"
#include "encoder/codec/math/principal_components.h"
#include "encoder/codec/math/symmetric_system.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

class RigFactors {
 public:
  // Keeps a reference to the rig.
  explicit RigFactors(const KeptRig& kept);

  std::size_t count() const { return unit_.size(); }
  // Returns the sum of the squared factors of a trajectory.
  double energy(std::size_t l) const { return energy_[l]; }
  // Returns the factors of some vertices, [vertex][trajectory].
  std::vector<double> of(std::size_t first, std::size_t num_vertices) const;
  // Returns the temporal values, [trajectory][frames.num_frames of the rows], with which the
  // factors come closest to the displacements.
  std::vector<double> fit(const TrajectoryRows& displacement) const;

 private:
  const KeptRig& kept_;
  std::vector<double> unit_;  // [trajectory], of normalised factors
  std::vector<double> energy_;
  SymmetricSystem system_;
};

// Residual of some frames after the bones of a rig and, once temporal values are set, after its
// trajectories too.
class RigRemainder {
 public:
  // motions: the bones in the chosen frames. Keeps references to rig, factors and frames.
  RigRemainder(const KeptRig& kept, const RigFactors& factors, const SpanFrames& frames,
               std::vector<std::uint32_t> chosen, MotionsOfBones motions)
      : kept_(kept),
        factors_(factors),
        frames_(frames),
        chosen_(std::move(chosen)),
        motions_(std::move(motions)) {}

  std::size_t width() const { return 3 * chosen_.size(); }
  // Sets the temporal values, [trajectory][width()]: for each coordinate, the chosen frames.
  void set_temporal(std::vector<double> temporal);
  // Returns the residual, a row for each coordinate of a vertex; valid as long as the object.
  TrajectoryRows rows() const;

 private:
  void write(std::size_t first, std::span<double> rows) const;

  const KeptRig& kept_;
  const RigFactors& factors_;
  const SpanFrames& frames_;
  std::vector<std::uint32_t> chosen_;
  MotionsOfBones motions_;
  std::vector<double> negative_;  // negated temporal values; empty: none
};

}  // namespace rlpc
