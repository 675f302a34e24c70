// Values of attributes as numbers (F.3), and normals of any frame (F.8.5).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/topology.h"
#include "common/memory/owned.h"

namespace rlpc {

// Returns the components of the numbers of a set: 3 for unit vectors, 0 for smoothing.
std::uint32_t number_components(const AttributeHeader& header);
// Returns [value][component]: integers scaled by value_scale_idc, floats, or unit vectors as x,
// y, z.
Vector<float> attribute_numbers(const AttributeSet& set);

// Returns the set with a name; null if there is none.
const AttributeSet* find_set(const Vector<AttributeSet>& sets, const char* name);

// Returns the unit vector of a sum; (0, 0, 1) if it is zero, as where triangles have no area.
std::array<double, 3> unit_normal(const double* sum);

// Computes the normals of frames. The set and the triangles must outlive it.
class FrameNormals {
 public:
  // set: `normal`, of vertices or corners; its indices are those of the normals.
  FrameNormals(const AttributeSet& set, std::span<const Triangle> triangles,
               std::uint32_t num_vertices);

  std::uint32_t count() const { return count_; }
  // Returns the index of the normal at corner 3 * t + k.
  std::uint32_t normal_of_corner(std::size_t corner) const {
    return set_.value_of_corner.empty() ? triangles_[corner / 3][corner % 3]
                                        : set_.value_of_corner[corner];
  }
  // Return vectors [count()][3] of any length from the vertices of a frame, in units of the
  // caller or the grid; valid until the next call, which allocates nothing. Time: proportional
  // to the corners. Unit vectors of the stream, which belong to its first frame, turn with the
  // surface around their vertex, or follow the surface (F.8.5), if the set has the positions of
  // that frame; otherwise they are returned unchanged.
  std::span<const double> sums(std::span<const float> xyz);
  std::span<const double> sums(std::span<const std::int32_t> positions);
  // Computes unit vectors; (0, 0, 1) where the sum is zero. normals: [count()][3], in which
  // normals that restrict_to() leaves out stay unchanged.
  void compute(std::span<const float> xyz, std::span<float> normals);
  // Leaves out all other normals from now on, to save their time. wanted: [count()]. May be
  // called once.
  void restrict_to(Vector<std::uint8_t> wanted);

 private:
  template <class Coordinate>
  void add_up(std::span<const Coordinate> xyz);
  void find_terms();
  void keep_first();
  void find_followers();
  void find_turning_vertices();
  // Returns whether a normal is computed from the positions of the frame.
  bool follows(std::uint32_t normal) const { return follows_.empty() || follows_[normal] != 0; }
  bool is_wanted(std::uint32_t normal) const { return wanted_.empty() || wanted_[normal] != 0; }
  template <class Coordinate>
  void turn_first(std::span<const Coordinate> xyz);
  template <class Coordinate>
  void find_sums(std::span<const Coordinate> xyz);

  const AttributeSet& set_;
  std::span<const Triangle> triangles_;
  std::uint32_t count_ = 0;
  // Each face once per normal, unless angles are the weights.
  Vector<std::array<std::uint32_t, 2>> terms_;  // normal, face
  Vector<std::uint32_t> angles_;                // corners whose angles are weights
  Vector<std::array<double, 3>> faces_;
  Vector<double> sums_;
  Vector<std::uint8_t> wanted_;      // [normal]; empty: all
  Vector<std::uint8_t> has_wanted_;  // [triangle] whether it has a wanted normal; empty: all
  // Unit vectors of the first frame, flags of those that follow the surface, and the corners
  // around which the others turn.
  Vector<float> first_;
  Vector<std::uint8_t> follows_;
  ListOfLists<std::uint32_t> corners_;      // [vertex] its corners
  Vector<std::uint32_t> turning_vertices_;  // vertices with a wanted normal that turns
};

}  // namespace rlpc
