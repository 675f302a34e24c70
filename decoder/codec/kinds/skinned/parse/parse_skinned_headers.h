// 6.11 to 6.13: elements of skinned GOFs, shared rigs and slices before their sections, parsing
// side. Errors are left in the reader.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/access_unit.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

// Parses rig_idx of a rig unit, or of a skinned GOF with a shared rig.
std::uint32_t parse_rig_idx(BitReader& r);

// 6.11 rig_header( ), up to the bone section. num_layers: layers of the mesh. Sets layer groups
// and steps only for prediction in layers. Returns the number of bones.
std::uint32_t parse_rig_header(BitReader& r, const SequenceHeader& header,
                               std::uint32_t num_layers, SharedRig& rig);

// 6.11 levels_of_tracks( )
void parse_levels_of_tracks(BitReader& r, SkinnedGof& gof);

// 6.13.1 tracks_of_gof( ), after rig_idx, up to the alignment. rig_groups: component groups
// of the shared rig.
void parse_tracks_header(BitReader& r, std::uint32_t rig_groups, SkinnedGof& gof);

// What a GOF or shared rig has slices of.
struct SliceCounts {
  std::uint32_t component_groups = 0;  // includes the influences, which are not factors
  std::uint32_t layer_groups = 1;
  std::uint32_t temporal_layers = 1;
};

// 6.12 slice_unit( ), up to its section
SliceEntry parse_slice_header(BitReader& r, const SliceCounts& counts);

}  // namespace rlpc
