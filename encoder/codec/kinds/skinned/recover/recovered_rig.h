// Recovers the rig of a skinned mesh from its frames alone.
#pragma once

#include <optional>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

struct RecoveredRig {
  Rig rig;
  double explained = 0.0;  // part of the vertices that it moves exactly
};

// Returns a rig of at least two bones; fix_joints() tells which of them to pin. None if the
// mesh was not skinned, was skinned otherwise than by linear blending of rigid bones, or if its
// numbers are not exact. Time and memory are linear in vertices and frames; most meshes that
// were not skinned are told from their first patches.
std::optional<RecoveredRig> recover_rig(const SpanFrames& frames,
                                        std::span<const Triangle> triangles);

}  // namespace rlpc
