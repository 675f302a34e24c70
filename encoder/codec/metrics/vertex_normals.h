// Deviation and flicker of vertex normals, by which smooth surfaces are shaded.
//
// The normal of a vertex is the direction of the sum of the normals of its triangles, weighted
// by area, as three.js computes it. Vertices without one in the original are skipped; where the
// decoded one is missing, it deviates by 90 degrees. Squares are weighted by the area of the
// vertex in the original, a third of that of its triangles.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/metrics/points.h"

namespace rlpc {

// A weighted sum of squared angles.
struct SquaredAngles {
  double sum = 0.0;     // squared degrees times area
  double weight = 0.0;  // area

  SquaredAngles& operator+=(const SquaredAngles& other) {
    sum += other.sum;
    weight += other.weight;
    return *this;
  }
  // Returns the root of the mean square, degrees; 0 without any vertex.
  double rms() const { return weight > 0.0 ? std::sqrt(sum / weight) : 0.0; }
};

// Returns the squared angles between the vertex normals of two frames. Both have three finite
// values for each vertex, in the vertex order of the triangles. Takes O(vertices + triangles).
SquaredAngles normal_deviation(std::span<const Triangle> triangles,
                               std::span<const double> original,
                               std::span<const float> decoded);

// Compares the vertex normals of consecutive frames.
class NormalErrors {
 public:
  struct OfFrame {
    SquaredAngles deviation;  // as normal_deviation() returns it
    // How much the error of each normal, as a vector, differs from that in the frame before, as
    // an angle: a constant error does not flicker. Nothing in the first frame.
    SquaredAngles flicker;
  };

  NormalErrors(std::uint32_t num_vertices, std::span<const Triangle> triangles);

  // Adds the next frame.
  OfFrame add_frame(std::span<const float> original, std::span<const float> decoded);

 private:
  std::vector<Triangle> triangles_;
  std::vector<Vec3d> error_;  // [vertex] in the last frame
  bool has_frame_ = false;
};

}  // namespace rlpc
