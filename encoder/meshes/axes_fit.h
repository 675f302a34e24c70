// Finds out whether the frames of a point cache have the axes of their mesh.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "encoder/meshes/frame_source.h"

namespace rlpc {

// The distance between two poses is the angle between their positions, taken from the centre,
// as vectors of 3 * num_vertices coordinates: it depends on neither place nor size, and obeys
// the triangle inequality. Let D be the largest distance of a frame from the first one, a and b
// the smallest distances of the mesh from the frames, as they are and with other axes. The
// frames have those other axes
// - if b is zero, up to the rounding of text, and a is not: the mesh is one of the frames; or
// - if a - b > D and a - b > b: other axes gain more than any motion of the animation changes,
//   and more than they leave; and if they exchange y and z, as an animation rarely does, while
//   turns about the vertical are motions like others. The mesh is then a pose that no frame
//   has, such as a rest pose.
//
// So it cannot tell that axes differ if the animation moves about as far as they do, or if the
// mesh resembles no frame; nor which side is mirrored of meshes that are flat.
class AxesFit {
 public:
  // mesh: 3 finite values per vertex, as in the frames.
  explicit AxesFit(std::span<const float> mesh);

  void add_frame(std::span<const float> xyz);
  // Whether a frame is equal to the mesh, so that no more frames are needed.
  bool matches() const;
  // Returns the axes to turn frames to so that they have those of the mesh; none if they have
  // them, or if the fit cannot tell.
  std::optional<Axes> axes_of_mesh() const;

 private:
  static constexpr std::size_t kNumAxes = 48;  // permutations of three axes, with signs

  std::vector<float> mesh_;   // relative to its centre
  std::vector<float> first_;  // first frame, relative to its centre
  double mesh_square_ = 0.0;  // sums of squares
  double first_square_ = 0.0;
  std::array<double, kNumAxes> nearest_{};  // the smallest angle of a frame to the mesh
  double motion_ = 0.0;                     // the largest angle of a frame to the first
};

}  // namespace rlpc
