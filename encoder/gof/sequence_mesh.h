// The mesh of a sequence, in decoded order.
#pragma once

#include <span>

#include "common/mesh/mesh.h"
#include "common/mesh/topology.h"
#include "common/syntax/sequence_header.h"

namespace rlpc {

struct SequenceMesh {
  const SequenceHeader& header;  // of which the grid may change
  const Topology& topology;
  std::span<const Triangle> triangles;
};

}  // namespace rlpc
