// What the skinned GOFs of a sequence have in common.
#pragma once

#include <span>

#include "common/mesh/coded_meshes.h"
#include "common/mesh/mesh.h"
#include "common/syntax/sequence_header.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/skinned_gof/quantise/skinned_analysis.h"

namespace rlpc {

struct SkinnedContext {
  const SequenceHeader& header;  // of which the grid may change
  const EncoderSettings& settings;
  std::span<const Triangle> triangles;  // decoded order
  CodedMeshes meshes;
};

// The tools that are tried first.
SkinnedSettings usual_settings(const EncoderSettings& settings);

}  // namespace rlpc
