// Starts encodings of an inter GOF, and keeps what they share.
#pragma once

#include <cstdint>
#include <map>
#include <memory>

#include "common/codec/mesh/ordered_mesh.h"
#include "encoder/codec/kinds/inter/inter_settings.h"
#include "encoder/codec/kinds/inter/inter_trial.h"
#include "encoder/codec/rest/rest_coding.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/sequence_mesh.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

class TrialMaker {
 public:
  // layers: the mesh, which has layers. num_frames: of the GOF that the frames are a sample of.
  // Keeps references to all.
  TrialMaker(const SequenceMesh& mesh, const OrderedMesh& layers,
             const EncoderSettings& settings, const SpanFrames& frames,
             std::uint32_t num_frames)
      : mesh_(mesh),
        layers_(layers),
        settings_(settings),
        frames_(frames),
        num_frames_(num_frames) {}

  // Starts an encoding at a quantiser step, in grid steps. One call at a time.
  std::unique_ptr<InterTrial> start(const InterChoice& choice, double step);
  // Forgets first frames, whose steps are those of earlier calls.
  void forget_first_frames() { first_frames_.clear(); }

 private:
  const PatchOfVertex& patches(std::uint32_t count);
  std::shared_ptr<const RestEncoding> first_frame(const InterSettings& chosen);

  const SequenceMesh& mesh_;
  const OrderedMesh& layers_;
  const EncoderSettings& settings_;
  const SpanFrames& frames_;
  std::uint32_t num_frames_;
  std::map<std::uint32_t, PatchOfVertex> patches_;  // [number of patches]
  // [step of depth 0]
  std::map<std::uint32_t, std::shared_ptr<const RestEncoding>> first_frames_;
};

}  // namespace rlpc
