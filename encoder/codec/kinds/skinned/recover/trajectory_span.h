// Rotations in the linear span of the trajectories of a few vertices. A skinned vertex moves
// along a combination of the columns of the rotations of its bones and of their origins. So the
// span of such trajectories has these columns in it, and hardly any other rotation if there are
// many more frames than dimensions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/damping.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"

namespace rlpc {

using Rotations = std::vector<Eigen::Matrix3d>;  // [frame]

// Orthonormal columns that span those of some rotations.
struct RotationColumns {
  std::size_t count = 0;
  std::vector<double> values;  // [3 * frame][count]
};
RotationColumns orthonormal_columns(std::span<const Rotations* const> rotations);

// The span of the trajectories of some vertices, relative to their mean.
class TrajectorySpan {
 public:
  // vertices: at least one. tolerance: directions along which the RMS of a coordinate, in
  // extents, is less are left out.
  TrajectorySpan(const Trajectories& trajectories, std::span<const std::uint32_t> vertices,
                 double tolerance);

  std::size_t rank() const { return rank_; }

  struct Found {
    Rotations rotation;              // the identity in the first frame
    std::vector<Vec3d> combination;  // [vertex]: columns are the sums of positions times these
    double error = 0.0;  // RMS of an element of M^T M - 1, where M is the nearest in the span
  };
  // Returns a rotation near `start` that is in the span, or as near to the span as can be.
  // Takes a time that is linear in frames and, for the usual few dimensions, quadratic in
  // these.
  Found rotation_near(const Rotations& start) const;

  // Returns how far the two nearest columns of a rotation are from the span: 0 to 1. Two
  // suffice, as a flat part of a mesh shows no more.
  double distance(const Rotations& rotation) const;
  // Returns the RMS of a coordinate, in extents, that is left of the trajectories if they are
  // combined from columns.
  double unexplained(const RotationColumns& columns) const;

 private:
  std::vector<double> coordinates(const Rotations& rotation) const;
  Rotations matrices(std::span<const double> coordinates) const;
  struct StrainEquations {
    std::vector<double> a;  // [3 * rank][3 * rank], upper triangle
    std::vector<double> b;  // [3 * rank]
    double mean = 0.0;      // of the diagonal
  };
  StrainEquations strain_equations(std::span<const double> coordinates) const;
  double step(std::vector<double>& coordinates, Damping& damping, double before) const;

  std::size_t num_frames_ = 0;
  std::size_t num_vertices_ = 0;
  std::size_t rank_ = 0;
  std::vector<double> energy_;       // [rank], squared extents
  std::vector<double> basis_;        // [3 * frame][rank], orthonormal columns
  std::vector<double> combination_;  // [vertex][rank]: the basis, from positions
};

}  // namespace rlpc
