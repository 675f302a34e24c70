// Codes the first frame of an inter GOF, which is predicted from no other frame.
#pragma once

#include <memory>
#include <span>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/rest/rest_coding.h"
#include "encoder/codec/settings.h"

namespace rlpc {

// Codes the frame in an order of its own (8.18), at the step of depth 0; null if coding it in
// layers costs less or several layer groups need it, or if the settings exclude the order. xyz
// [num_vertices][3], in grid units. Takes some 10 us per vertex, a third of that with the fast
// preset.
std::shared_ptr<const RestEncoding> code_first_frame(const OrderedMesh& mesh,
                                                     const InterSettings& frame_settings,
                                                     const SequenceHeader& header,
                                                     const EncoderSettings& settings,
                                                     std::span<const double> xyz);

}  // namespace rlpc
