// 6.11 and 6.12: bones of a GOF, and slices, writing side.
#pragma once

#include <cstdint>
#include <vector>

#include "common/mesh/coded_mesh.h"
#include "common/skinned_gof/skinned_gof.h"

namespace rlpc {

// Payloads of the unit of a skinned GOF and of its slice units. All values must be legal
// (asserted). gof.slice_layers says which slices are written.
struct SkinnedGofPayloads {
  std::vector<std::uint8_t> gof;
  std::vector<std::vector<std::uint8_t>> slices;
};
SkinnedGofPayloads write_skinned_gof(const SkinnedGof& gof, const CodedMesh& mesh,
                                     int position_bits);

}  // namespace rlpc
