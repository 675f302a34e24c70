// The rig of an input: the bones that move its vertices, where the file has them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rlpc {

// Three rows of four: row . (x, y, z, 1) is a coordinate of the image.
using BoneMap = std::array<std::array<double, 4>, 3>;

// The rig places vertex v in a frame at the sum of weight * map(rest position of v) over its
// influences, where map is that of the bone in the frame (FrameSource::read_bones()). Frames
// may differ from that, as other things than bones may move vertices.
struct SourceRig {
  struct Bone {
    std::int32_t parent = -1;       // index of an earlier bone; -1: none
    std::array<double, 3> pivot{};  // joint with the parent, in the rest shape
  };
  struct Influence {
    std::uint32_t bone = 0;
    float weight = 0.0F;  // above 0
  };

  std::vector<Bone> bones;   // at least two
  std::vector<double> rest;  // the rest shape: xyz per vertex, in units
  // The influences of vertex v, at least one, are influences[first_influence[v]] up to, but not
  // including, influences[first_influence[v + 1]]. Their weights may have any sum.
  std::vector<std::size_t> first_influence;
  std::vector<Influence> influences;

  // Returns the estimated memory that the rig takes.
  std::uint64_t memory_bytes() const {
    return sizeof(Bone) * bones.size() + sizeof(double) * rest.size() +
           sizeof(std::size_t) * first_influence.size() + sizeof(Influence) * influences.size();
  }
};

// Returns the rig of some of the vertices, in their order. vertices: indices.
SourceRig rig_of_vertices(const SourceRig& rig, const std::vector<std::uint32_t>& vertices);

}  // namespace rlpc
