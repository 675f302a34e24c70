// A kind of GOF: one way to code the frames of one, in a folder of its own.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_frames.h"
#include "encoder/gof/sequence_mesh.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

class GofEncoder {
 public:
  virtual ~GofEncoder() = default;
  // Frames are kept by reference.
  virtual std::unique_ptr<GofCoder> make_coder(const GofFrames& frames) const = 0;
  // Lagrangian cost that a coder of this kind is expected to come to, from a quick look. best:
  // of the kinds before this one. None: no look is needed to tell that it comes to more.
  virtual std::optional<double> estimate_cost(const GofFrames& frames, const EncodedGof& best,
                                              double step) const = 0;
};

using GofKinds = std::vector<std::unique_ptr<GofEncoder>>;

// Null where the profile or the settings do not allow for the kind. Mesh and settings are kept
// by reference.
using MakeGofKind = std::unique_ptr<GofEncoder> (*)(const SequenceMesh& mesh,
                                                    const EncoderSettings& settings);

}  // namespace rlpc
