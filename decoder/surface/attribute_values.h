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

// Components of the numbers of a set: 3 of unit vectors, 0 of smoothing.
std::uint32_t number_components(const AttributeHeader& header);
// [value][component]: integers as value_scale_idc says, floats, unit vectors as x, y, z.
Vector<float> attribute_numbers(const AttributeSet& set);

// The set of that name; null: none.
const AttributeSet* find_set(const Vector<AttributeSet>& sets, const char* name);

// Of length 1; (0, 0, 1) if the sum has none, as where triangles have no area.
std::array<double, 3> unit_normal(const double* sum);

// Computes the normals of frames. The set and the triangles must outlive it.
class FrameNormals {
 public:
  // set: `normal`, of vertices or corners; its index at a corner is that of a normal here.
  FrameNormals(const AttributeSet& set, std::span<const Triangle> triangles,
               std::uint32_t num_vertices);

  std::uint32_t count() const { return count_; }
  // Index of the normal at corner 3 * t + k.
  std::uint32_t of_corner(std::size_t corner) const {
    return set_.value_of_corner.empty() ? triangles_[corner / 3][corner % 3]
                                        : set_.value_of_corner[corner];
  }
  // [count()][3], of any length, from the vertices of a frame, in units of the caller or of the
  // grid; valid until the next call, which allocates nothing. Time: in proportion to the
  // corners. Unit vectors of the stream, which are those of the first frame, turn with the
  // surface around their vertex in others if the set has its positions, or follow the surface
  // (F.8.5); without positions, they are given as they are.
  std::span<const double> sums(std::span<const float> xyz);
  std::span<const double> sums(std::span<const std::int32_t> positions);
  // The same, of length 1; (0, 0, 1) where there is none. normals: [count()][3]; those that
  // restrict_to() leaves out stay as they are.
  void compute(std::span<const float> xyz, std::span<float> normals);
  // Leaves out all other normals from now on, which saves their time. wanted: [count()]; may be
  // called once.
  void restrict_to(Vector<std::uint8_t> wanted);

 private:
  template <class Coordinate>
  void add_up(std::span<const Coordinate> xyz);
  void find_terms();
  void keep_first();
  void find_followers();
  void find_turning_vertices();
  // Whether a normal is computed from the positions of the frame.
  bool follows(std::uint32_t normal) const { return follows_.empty() || follows_[normal] != 0; }
  bool is_wanted(std::uint32_t normal) const { return wanted_.empty() || wanted_[normal] != 0; }
  template <class Coordinate>
  void turn_first(std::span<const Coordinate> xyz);
  template <class Coordinate>
  void find_sums(std::span<const Coordinate> xyz);

  const AttributeSet& set_;
  std::span<const Triangle> triangles_;
  std::uint32_t count_ = 0;
  // Each face once at each of its normals, unless angles are the weights.
  Vector<std::array<std::uint32_t, 2>> terms_;  // normal, face
  Vector<std::uint32_t> angles_;                // the corners whose angles are weights
  Vector<std::array<double, 3>> faces_;
  Vector<double> sums_;
  Vector<std::uint8_t> wanted_;      // [normal]; empty: all
  Vector<std::uint8_t> has_wanted_;  // [triangle], its face has such a normal; empty: all
  // Unit vectors of the first frame, which of them follow the surface, and the corners around
  // which the others turn.
  Vector<float> first_;
  Vector<std::uint8_t> follows_;
  ListOfLists<std::uint32_t> corners_;      // of each vertex
  Vector<std::uint32_t> turning_vertices_;  // those with a wanted normal that turns
};

}  // namespace rlpc
