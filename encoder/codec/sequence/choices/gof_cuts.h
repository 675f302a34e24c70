// Divides a sequence into GOFs.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/codec/spans/frame_range.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Returns the GOFs of at most `longest` frames with the lowest expected cost, cut where the
// motion changes; or equal_gofs(), unless these are clearly more expensive. Reads each frame
// once and keeps a sample of the vertices; time is linear in frames. Very long sequences get
// equal GOFs, because the memory limit would leave too small a sample of each frame.
//
//   step  likely quantiser step, in the unit of the coordinates
//
// Errors: errors of the source.
InputResult<std::vector<FrameRange>> cheapest_gofs(FrameSource& source, std::uint32_t longest,
                                                   double step);

// Returns the maximum number of frames of a GOF: `shortest` times a power of two, at most
// `longest`. Each GOF codes the shape again, so long ones cost less where it moves little;
// short ones are faster to seek in, and are preferred unless they cost notably more. Reads each
// frame once. Very long sequences get the longest.
//
//   step  as above
//
// Errors: errors of the source.
InputResult<std::uint32_t> choose_longest_gof(FrameSource& source, std::uint32_t shortest,
                                              std::uint32_t longest, double step);

}  // namespace rlpc
