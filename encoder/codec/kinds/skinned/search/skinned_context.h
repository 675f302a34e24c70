// The data shared by all skinned GOFs of a sequence.
#pragma once

#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/ordered_meshes.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/kinds/skinned/quantise/skinned_analysis.h"
#include "encoder/codec/settings.h"

namespace rlpc {

struct SkinnedContext {
  const SequenceHeader& header;  // its grid and level may change later
  const EncoderSettings& settings;
  std::span<const Triangle> triangles;  // decoded order
  OrderedMeshes meshes;
};

// Returns the tools that the search starts from, as far as the settings leave a choice.
SkinnedSettings usual_settings(const EncoderSettings& settings);

}  // namespace rlpc
