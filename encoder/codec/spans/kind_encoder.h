// The interface of a kind of GOF (clusters or a skinned mesh); each kind has its own folder.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/codec/settings.h"
#include "encoder/codec/spans/sequence_mesh.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Makes the coders of one kind of GOF.
class KindEncoder {
 public:
  virtual ~KindEncoder() = default;
  // Makes a coder, which keeps a reference to the frames.
  virtual std::unique_ptr<SpanCoder> make_coder(const SpanFrames& frames) const = 0;
  // Encodes the frames with the shared rig of an earlier span. None: this costs at least
  // `most`, or is expected to, or the kind has no rigs.
  virtual std::optional<EncodedSpan> encode_with(const KeptRig& /*rig*/,
                                                 const SpanFrames& /*frames*/, double /*step*/,
                                                 double /*most*/) const {
    return std::nullopt;
  }
};

using KindEncoders = std::vector<std::unique_ptr<KindEncoder>>;

// Makes the encoder of a kind; null if profile or settings exclude it. The result keeps
// references to mesh and settings.
using MakeKindEncoder = std::unique_ptr<KindEncoder> (*)(const SequenceMesh& mesh,
                                                         const EncoderSettings& settings);

}  // namespace rlpc
