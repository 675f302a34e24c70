// 6.11 to 6.13 Skinned GOFs, shared rigs and their slices, writing side.
#pragma once

#include <cstdint>
#include <vector>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// Payloads of a GOF or rig unit and of its slice units.
struct SkinnedGofPayloads {
  std::vector<std::uint8_t> first;
  std::vector<std::vector<std::uint8_t>> slices;
  std::vector<std::uint32_t> temporal_layer_idx;  // [slice]
};
// The functions below write the slices that slice_layers and temporal_layers list. All values
// must be legal, which is asserted.
//
// 6.11 bones_of_gof( )
SkinnedGofPayloads write_skinned_gof(const SkinnedGof& gof, const OrderedMesh& mesh,
                                     const SequenceHeader& header);
// 6.13 rig( )
SkinnedGofPayloads write_shared_rig(const SharedRig& rig, std::uint32_t rig_idx,
                                    const OrderedMesh& mesh, const SequenceHeader& header);
// 6.13.1 tracks_of_gof( )
SkinnedGofPayloads write_tracks(const SkinnedGof& gof, const OrderedMesh& mesh,
                                const SequenceHeader& header);

}  // namespace rlpc
