// The interface of a kind of GOF (clusters or a skinned mesh); each kind has its own folder.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/codec/settings.h"
#include "encoder/codec/spans/gof_coder.h"
#include "encoder/codec/spans/gof_frames.h"
#include "encoder/codec/spans/sequence_mesh.h"

namespace rlpc {

// Makes the coders of one kind of GOF.
class GofEncoder {
 public:
  virtual ~GofEncoder() = default;
  // The coder keeps a reference to the frames.
  virtual std::unique_ptr<GofCoder> make_coder(const GofFrames& frames) const = 0;
  // Whether this kind may code the frames at less cost than the likeliest kind.
  //
  //   components  that the likeliest kind is expected to need
  virtual bool may_win(const GofFrames& frames, std::uint32_t components) const = 0;
  // Encodes the frames with the skinned model of an earlier span. None: that costs at least
  // `most`, or is expected to, or the kind has no models.
  virtual std::optional<EncodedGof> encode_with(const KeptModel& /*model*/,
                                                const GofFrames& /*frames*/, double /*step*/,
                                                double /*most*/) const {
    return std::nullopt;
  }
};

using GofKinds = std::vector<std::unique_ptr<GofEncoder>>;

// Null if profile or settings exclude the kind. The result keeps references to mesh and
// settings.
using MakeGofKind = std::unique_ptr<GofEncoder> (*)(const SequenceMesh& mesh,
                                                    const EncoderSettings& settings);

}  // namespace rlpc
