// Rotation of the surface around a vertex from one frame to another (F.8.5).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/mesh/corners.h"
#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Least-squares rotation from vectors before to vectors after (Horn 1987). Its quaternion is
// the eigenvector of the largest eigenvalue of a matrix of their products, which Newton's
// method reaches from above (Theobald 2005).
class LocalTurn {
 public:
  using Vec3 = std::array<double, 3>;

  void add_edge(const Vec3& before, const Vec3& after);
  // Adds the normal of a triangle before and after, as long as its area, or twice its area.
  void add_area(const Vec3& before, const Vec3& after);
  // Finds the rotation, after all edges and areas. The sum of the areas counts as a vector
  // along the normal, whose squared length is the area. Returns false if the rotation is not
  // unique, as for collinear vectors; vectors then stay unchanged.
  bool find();
  Vec3 turned(const Vec3& vector) const;
  // Undoes turned().
  Vec3 turned_back(const Vec3& vector) const;

 private:
  std::array<Vec3, 3> products_{};  // [before][after]
  double squares_before_ = 0.0;     // sum of the squared lengths of all vectors
  double squares_after_ = 0.0;
  Vec3 area_before_{};
  Vec3 area_after_{};
  std::array<Vec3, 3> rotation_{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
};

// Adds the surface around the corners of a vertex: the edges and areas of their triangles.
// before, after: [vertex][3].
template <class Before, class After>
void add_surroundings(std::span<const Triangle> triangles,
                      std::span<const std::uint32_t> corners, std::span<const Before> before,
                      std::span<const After> after, LocalTurn& turn) {
  using Vec3 = LocalTurn::Vec3;
  const auto difference = [](const auto& xyz, std::uint32_t from, std::uint32_t to) {
    Vec3 v{};
    for (std::size_t c = 0; c < 3; ++c) {
      v[c] = static_cast<double>(xyz[3 * std::size_t{to} + c]) -
             static_cast<double>(xyz[3 * std::size_t{from} + c]);
    }
    return v;
  };
  const auto cross = [](const Vec3& a, const Vec3& b) {
    return Vec3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                a[0] * b[1] - a[1] * b[0]};
  };
  for (const std::uint32_t c : corners) {
    const std::uint32_t v = vertex_of_corner(triangles, c);
    const std::uint32_t p = vertex_of_corner(triangles, next_corner(c));
    const std::uint32_t q = vertex_of_corner(triangles, previous_corner(c));
    const std::array<Vec3, 2> old{difference(before, v, p), difference(before, v, q)};
    const std::array<Vec3, 2> now{difference(after, v, p), difference(after, v, q)};
    for (std::size_t k = 0; k < 2; ++k) turn.add_edge(old[k], now[k]);
    turn.add_area(cross(old[0], old[1]), cross(now[0], now[1]));
  }
}

}  // namespace rlpc
