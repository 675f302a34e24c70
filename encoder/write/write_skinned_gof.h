// 6.11 and 6.12 Skinned GOFs and their slices, writing side.
#pragma once

#include <cstdint>
#include <vector>

#include "common/mesh/coded_mesh.h"
#include "common/skinned_gof/skinned_gof.h"
#include "common/syntax/sequence_header.h"

namespace rlpc {

// Payloads of the GOF unit and the slice units of a skinned GOF.
struct SkinnedGofPayloads {
  std::vector<std::uint8_t> gof;
  std::vector<std::vector<std::uint8_t>> slices;
};
// Writes the slices that gof.slice_layers lists. All values must be legal, which is asserted.
SkinnedGofPayloads write_skinned_gof(const SkinnedGof& gof, const CodedMesh& mesh,
                                     const SequenceHeader& header);

}  // namespace rlpc
