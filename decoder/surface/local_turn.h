// How the surface around a vertex turns from one frame to another (F.8.5).
#pragma once

#include <array>

namespace rlpc {

// The rotation that brings vectors nearest to what they become, in the sense of least squares
// (Horn 1987). Its quaternion belongs to the largest eigenvalue of a matrix of their products,
// which Newton's method reaches from above (Theobald 2005).
class LocalTurn {
 public:
  using Vec3 = std::array<double, 3>;

  void add_edge(const Vec3& before, const Vec3& after);
  // The normal of a triangle, as long as its area, or twice that, before and after.
  void add_area(const Vec3& before, const Vec3& after);
  // After all edges and areas. The sum of the areas counts as a vector along the normal, whose
  // squared length is the area.
  void find();
  // As it is, if no rotation is the nearest: where all is on a line.
  Vec3 turned(const Vec3& vector) const;

 private:
  std::array<Vec3, 3> products_{};  // [before][after]
  double squares_before_ = 0.0;     // of the lengths of all vectors
  double squares_after_ = 0.0;
  Vec3 area_before_{};
  Vec3 area_after_{};
  std::array<Vec3, 3> rotation_{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
};

}  // namespace rlpc
