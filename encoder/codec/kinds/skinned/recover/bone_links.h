// Finds vertices that follow two bones and no other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_chains.h"
#include "encoder/codec/kinds/skinned/recover/bone_space.h"
#include "encoder/codec/kinds/skinned/recover/placed_bones.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"

namespace rlpc {

// A vertex that follows two bones moves along their rotations, as seen from the pivot of
// either. That holds wherever the bones are in the rest shape, so it shows that a vertex
// follows them before anything is known of its weights.
class BoneLinks {
 public:
  // Looks at a sample of the vertices that may follow several bones.
  BoneLinks(const Trajectories& trajectories, const BoneChains& chains, const BoneSpace& space);

  // Finds the vertices that follow a bone with a place and one other bone.
  void add(const PlacedBones& bones, std::size_t bone);

  // Returns those that follow two bones: numbers of vertices, ascending. first: one for which
  // add() was called
  const std::vector<std::uint32_t>& between(std::size_t first, std::size_t second) const {
    return links_[first * num_bones_ + second];
  }

 private:
  struct Vertex {
    std::uint32_t number = 0;
    std::vector<double> products;  // BoneSpace::products()
    double square = 0.0;           // of the trajectory
  };
  double left_of(const Vertex& v, std::span<const double> point,
                 const std::vector<std::size_t>& along) const;

  const BoneChains& chains_;
  const BoneSpace& space_;
  std::size_t num_bones_;
  std::size_t num_values_;  // coordinates of a trajectory
  std::vector<Vertex> vertices_;
  std::vector<std::vector<std::uint32_t>> links_;  // [bone][bone]
};

}  // namespace rlpc
