// Bones, their influences on vertices and their poses, for writers of skinned meshes: from
// skinned GOFs (8.12, 8.13), and from cluster GOFs, whose local coordinate frames (8.4) become
// bones.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/codec/bits/int_math.h"
#include "common/memory/owned.h"

namespace rlpc {

// Place of a bone: the images of its axes, 30 fractional bits, at right angles and of length 1
// unless it or one that it descends from stretches; and its origin, 1/16 grid units.
struct BonePlace {
  std::array<Vec3l, 3> axes{};
  Vec3l origin{};
  bool operator==(const BonePlace&) const = default;
};

struct SkeletonBone {
  std::int32_t parent = -1;  // index of an earlier bone; -1: none
  BonePlace bind;            // place in the rest shape
  bool operator==(const SkeletonBone&) const = default;
};

struct SkeletonInfluence {
  std::uint16_t bone = 0;
  std::uint16_t weight = 0;  // above 0; relative to the sum of weights at the vertex
  bool operator==(const SkeletonInfluence&) const = default;
};

// Bones and influences. Excludes the rest shape, which follows from the frames and the poses.
struct Skeleton {
  Vector<SkeletonBone> bones;                    // at least one
  Vector<Vector<SkeletonInfluence>> influences;  // [num_vertices], at least one each
  // Measures of the error of the stream: the step of rest positions or seed tracks, 1/16 grid
  // units; and the number of coded values per vertex, besides those of frames.
  std::uint32_t step = 1;
  std::size_t values_of_vertex = 0;
  bool operator==(const Skeleton&) const = default;
};

// Places of the bones in one frame.
struct SkeletonPose {
  std::shared_ptr<const Skeleton> skeleton;
  Vector<BonePlace> places;    // [bone]
  std::size_t num_values = 0;  // number of values coded for the frame
};

}  // namespace rlpc
