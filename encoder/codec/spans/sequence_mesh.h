// The mesh shared by all GOFs of a sequence, in decoded order.
#pragma once

#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/topology.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

struct SequenceMesh {
  const SequenceHeader& header;  // its grid and level may change later
  const Topology& topology;
  std::span<const Triangle> triangles;
  // The same triangles with the rotation and order of the input. Empty unless the profile is
  // Baseline.
  std::span<const Triangle> input_triangles = {};
};

}  // namespace rlpc
