// Runs the reconstruction of a parsed GOF, for fuzz targets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/syntax/sequence_header.h"
#include "common/testing/fuzz_input.h"

namespace rlpc {

// Checks that the frames lie in the sequence, and their positions in the range of the header.
template <class Recon>
void fuzz_check_frames(const Recon& recon, const SequenceHeader& header,
                       std::uint32_t first_frame) {
  fuzz_check(recon.num_frames() <= header.num_frames - first_frame);
  std::vector<std::int32_t> positions(3 * std::size_t{header.num_vertices});
  const std::int32_t bound = std::int32_t{1} << (header.position_bits - 1);
  for (std::uint32_t f = 0; f < recon.num_frames(); ++f) {
    recon.frame(f, positions);
    for (const std::int32_t p : positions) fuzz_check(p >= -bound && p < bound);
  }
}

}  // namespace rlpc
