// Estimates, before anything is encoded, the KG error at which a bound of vertex normals is
// met.
#pragma once

#include <span>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Returns the KG error at which an encoding is expected to meet both bounds of a target with
// max_normals, above zero: noise is added to some frames until their vertex normals deviate as
// much as they may. The search goes on from what encodings show. Errors: errors of the source.
InputResult<double> expected_kg(FrameSource& source, std::span<const Triangle> triangles,
                                const Target& target);

}  // namespace rlpc
