// The rig of an input (encoder/meshes/source_rig.h), as a span of frames is analysed with it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/meshes/source_rig.h"

namespace rlpc {

// Returns the rig with the poses of the frames of a span, in grid units: rigid motions, the
// nearest to the maps of the bones, or with stretches where maps are not rigid. The rest shape
// is moved where it would be too far from the frames for its coordinates, and enlarged as much
// as bones grow, as axes are clipped (8.12.5). Bones that do not move relative to their parent
// are merged with it; those that no vertex follows are dropped, unless they join others. Null
// if fewer than two bones are left, or too many, or if numbers are so large that they are of no
// use.
//
//   maps          [frame][bone]
//   input_vertex  [decoded vertex], its index in the source
//   may_stretch   the profile has stretches
std::shared_ptr<const Rig> rig_of_span(const SourceRig& source, std::span<const BoneMap> maps,
                                       const SequenceHeader& header,
                                       std::span<const std::uint32_t> input_vertex,
                                       bool may_stretch);

// Returns the estimated memory of the poses of so many bones in a frame.
std::uint64_t pose_bytes(std::size_t num_bones);

}  // namespace rlpc
