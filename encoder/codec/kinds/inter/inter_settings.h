// Chooses the settings of an inter GOF.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/kinds/inter/closed_loop.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Returns how residuals are chosen: live, bounds of errors need the nearest. Where a pattern
// has several depths, following the ring gains nothing.
ResidualRule residual_rule(const EncoderSettings& settings, const FramePattern& pattern);

// step: quantiser step, in grid steps; not used if the target is lossless. For a pattern with
// several depths, it is the root mean square of their steps, so that error and worth of a bit
// are about those of other patterns.
InterSettings choose_frame_settings(const SequenceHeader& header,
                                    const EncoderSettings& settings, const OrderedMesh& layers,
                                    const FramePattern& pattern, double step);

// Returns the patch of each vertex, for at most `count` patches; empty if that is 0. Takes up
// to some seconds for 10,000 vertices.
//
//   triangles  of a mesh with vertices in the order of the frames
PatchOfVertex divide_into_patches(const SequenceHeader& header, const EncoderSettings& settings,
                                  const SpanFrames& frames, std::span<const Triangle> triangles,
                                  std::uint32_t count);
void set_patches(InterSettings& settings, const PatchOfVertex& patch_of_vertex);

}  // namespace rlpc
