// Data shared by parsing and reconstruction of all GOFs of a stream.
#pragma once

#include <optional>
#include <span>

#include "common/codec/mesh/ordered_meshes.h"
#include "common/codec/mesh/topology.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// Set before the first GOF, then read-only: any number of threads may use it.
struct StreamContext {
  SequenceHeader header;
  Topology topology;
  std::optional<OrderedMeshes> meshes;  // set if the profile has skinned GOFs

  StreamContext() = default;
  StreamContext(const StreamContext&) = delete;
  StreamContext& operator=(const StreamContext&) = delete;

  // Sets the connectivity, after the header. triangles: in decoded order, read during the call.
  void set_connectivity(std::span<const Triangle> triangles) {
    topology = make_topology(header.num_vertices, triangles);
    if (!header.has_skinned_gofs()) return;
    meshes.emplace(topology, triangles, header.profile_idc >= kProfileHigh);
  }
};

}  // namespace rlpc
