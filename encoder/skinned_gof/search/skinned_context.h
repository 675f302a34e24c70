// What the skinned GOFs of a sequence have in common.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/mesh/coded_mesh.h"
#include "common/mesh/mesh.h"
#include "common/syntax/sequence_header.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/skinned_gof/quantise/skinned_analysis.h"

namespace rlpc {

struct SkinnedContext {
  const SequenceHeader& header;  // of which the grid may change
  const EncoderSettings& settings;
  std::span<const Triangle> triangles;  // decoded order
  std::vector<CodedMesh> meshes;        // by Prediction

  const CodedMesh& mesh(Prediction prediction) const {
    return meshes[static_cast<std::size_t>(prediction)];
  }
};

// The tools that are tried first.
SkinnedSettings usual_settings(const EncoderSettings& settings);

}  // namespace rlpc
