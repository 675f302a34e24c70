// Fits the rest position and the weights of a vertex to placed bones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_space.h"
#include "encoder/codec/kinds/skinned/recover/placed_bones.h"
#include "encoder/codec/spans/rig.h"

namespace rlpc {

class SkinVertex {
 public:
  // Starts at the rest position from which the bone that moves the vertex most alike moves it
  // to its place in the first frame. candidates: bones that the vertex may follow, ascending,
  // with a place; none: those that move it most alike.
  SkinVertex(const PlacedBones& bones, std::span<const Vec3d> trajectory,
             std::vector<std::uint32_t> candidates);

  // Solves for weights and rest position in turn, then for both together.
  void fit(const PlacedBones& bones, int rounds);
  // Makes the bones that move the vertex most alike its candidates, and those that it follows.
  void widen(const PlacedBones& bones);

  // What a fit finds.
  struct Fit {
    Vec3d rest;
    std::vector<RigWeight> weights;  // in no order; none before a fit
    double squared_error = 0.0;
  };
  const Fit& fitted() const { return fit_; }
  void return_to(Fit fit) { fit_ = std::move(fit); }

  bool may_blend() const { return part_.bones.size() > 1; }
  const BoneSpace::Part& part() const { return part_; }
  // Returns the products of the trajectory with those of the coordinates of the part.
  const std::vector<double>& wanted() const { return wanted_; }

 private:
  void take(const BoneSpace& space, std::vector<std::uint32_t> bones);
  void fit_weights(const PlacedBones& bones);
  void fit_rest(const PlacedBones& bones);
  void polish(const PlacedBones& bones);
  double error_of_one(const PlacedBones& bones, std::uint32_t bone, const Vec3d& rest) const;
  std::vector<double> moved(const PlacedBones& bones) const;
  double error(const PlacedBones& bones) const;

  BoneSpace::Part part_;
  std::vector<double> products_;  // BoneSpace::products()
  std::vector<double> wanted_;
  double square_ = 0.0;  // of the trajectory
  Fit fit_;
};

// Returns gram * x.
std::vector<double> times(const std::vector<double>& gram, const std::vector<double>& x);

// Linear equations of small problems, in the metric of a Gram matrix.
struct NormalEquations {
  std::vector<double> a;  // [count][count]
  std::vector<double> b;  // [count]
};
// Returns those for the least squares of d * x - left.
//
//   d         [size][count], derivatives of coordinates
//   products  [size], gram * left
NormalEquations normal_equations(const std::vector<double>& gram, const std::vector<double>& d,
                                 const std::vector<double>& products, std::size_t count);

// Returns the derivatives of the coordinates of a point with respect to its rest position and,
// if the weights vary so that their sum stays, all weights but the last: [size][count].
std::vector<double> point_derivatives(const PlacedBones& bones, const BoneSpace::Part& part,
                                      std::span<const RigWeight> weights, const Vec3d& rest,
                                      bool weights_vary);

// Adds a 3 x 3 matrix to a part of a matrix with `width` columns.
void add_block(const Eigen::Matrix3d& m, std::size_t row, std::size_t column, std::size_t width,
               std::vector<double>& to);

}  // namespace rlpc
