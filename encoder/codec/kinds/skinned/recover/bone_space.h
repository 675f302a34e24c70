// Coordinates for the motion of vertices that follow bones with known rotations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_chains.h"
#include "encoder/codec/kinds/skinned/recover/bone_rotations.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"

namespace rlpc {

// In frame f, a vertex with rest position p is at the sum over its bones b of
// weight * (R_b T_b (p - c_b) + o_b), where R_b is the known rotation, T_b the turn of the bone
// between the rest shape and the first frame, and c_b its pivot in the rest shape. The origin
// o_b is that of the anchors. A bone without any hangs from its parent a, and has the origin
// o_a + R_a T_a (c_b - c_a).
//
// So all vertices move along a few trajectories: the columns of the rotations, and the origins
// of anchored bones. What is fitted in coordinates along these takes a time that does not
// depend on the number of frames.
class BoneSpace {
 public:
  // Starts with the anchored bones. Keeps a reference to the trajectories.
  BoneSpace(const Trajectories& trajectories, const BoneRotations& rotations,
            const BoneChains& chains);

  std::size_t num_bones() const { return num_bones_; }
  std::size_t width() const { return width_; }  // number of coordinates
  // Coordinates: three for each bone, and one for each origin.
  std::size_t block(std::size_t bone) const { return 3 * bone; }
  std::size_t origin(std::size_t bone) const { return 3 * num_bones_ + origin_[bone]; }
  double gram(std::size_t i, std::size_t j) const { return gram_[i * width_ + j]; }

  // Hangs a bone without a place from one that has one.
  void hang(std::size_t bone, std::size_t parent);
  // Undoes the last hang().
  void let_go(std::size_t bone);
  // Returns the bones that have a place, parents first.
  const std::vector<std::size_t>& order() const { return order_; }
  bool has_place(std::size_t bone) const { return !path_[bone].empty(); }
  bool is_anchored(std::size_t bone) const { return path_[bone].size() == 1; }
  std::size_t parent(std::size_t bone) const { return path_[bone][path_[bone].size() - 2]; }
  // Returns the bones from an anchored one to this one, each the parent of the next.
  const std::vector<std::uint32_t>& path(std::size_t bone) const { return path_[bone]; }

  // Returns the products of the trajectory of a vertex with those of all coordinates.
  std::vector<double> products(std::span<const Vec3d> trajectory) const;

  // Some of the bones, and the coordinates that they need.
  struct Part {
    std::vector<std::uint32_t> bones;      // ascending
    std::vector<std::uint32_t> blocks;     // bones on their paths, ascending
    std::vector<std::size_t> coordinates;  // three of each block, and origins
    std::vector<double> gram;              // [size][size], of the trajectories

    std::size_t size() const { return coordinates.size(); }
    std::size_t place(std::size_t bone) const;  // of its first coordinate
  };
  // bones: ascending, with a place
  Part part(std::vector<std::uint32_t> bones) const;

 private:
  std::vector<std::vector<double>> columns_of(const BoneRotations& rotations,
                                              const BoneChains& chains) const;

  const Trajectories& t_;
  std::size_t num_bones_;
  std::size_t width_ = 0;
  std::vector<std::size_t> order_;
  std::vector<std::vector<std::uint32_t>> path_;  // [bone]
  std::vector<std::size_t> origin_;               // [bone], that at the start of its path
  std::vector<double> columns_;                   // [3 * frame][width]
  std::vector<double> gram_;                      // [width][width]
};

}  // namespace rlpc
