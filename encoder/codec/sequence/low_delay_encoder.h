// Encodes frames that arrive one by one, each when it arrives, in inter GOFs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/mesh/ordered_meshes.h"
#include "encoder/codec/frame_format.h"
#include "encoder/codec/kinds/inter/closed_loop.h"
#include "encoder/codec/rest/rest_coding.h"
#include "encoder/codec/sequence/attribute_stage.h"
#include "encoder/codec/sequence/frame_backend.h"
#include "encoder/codec/sequence/sequence_coding.h"
#include "encoder/codec/sequence/step_control.h"
#include "encoder/codec/sequence/stream_assembly.h"
#include "encoder/codec/sequence/verified_output.h"

namespace rlpc {

// Searches for nothing: the step of a GOF follows from the target and the ratio of error to
// step so far.
class LowDelayEncoder final : public FrameBackend {
 public:
  LowDelayEncoder(FrameFormat format, EncoderSettings settings, ByteSink sink);

  std::optional<InputError> prepare() override;
  std::optional<InputError> add_frame(std::span<const float> xyz,
                                      std::span<const double> exact) override;
  InputResult<EncodeReport> finish() override;
  std::uint32_t num_added() const override { return num_added_; }

 private:
  // The GOF in progress.
  struct Gof {
    InterSettings settings;
    std::optional<ClosedLoop> coding;  // refers to the settings
    std::uint32_t announced = 0;       // number of frames
    std::uint32_t coded = 0;
    std::vector<double> before;  // the frame before, grid units
    // The first frame until it is coded, if it has an order of its own.
    std::shared_ptr<const RestEncoding> first;
  };

  std::optional<InputError> begin_stream(std::span<const float> xyz);
  std::optional<InputError> begin_gof(std::span<const float> xyz);
  std::optional<InputError> divide(std::span<const float> xyz);
  std::optional<InputError> code_first(std::span<const float> xyz, const OrderedMesh& layers);
  std::optional<InputError> code_frame(std::span<const float> xyz,
                                       std::span<const double> exact);
  void end_gof();
  std::optional<InputError> verify();
  Target target_for_floats() const;
  void follow_error();
  double step_for(double rms_spread) const;
  std::uint32_t frames_in_gof() const;
  InputError fail(InputError error) {
    failure_ = error;
    return error;
  }

  FrameFormat format_;
  EncoderSettings settings_;
  ByteSink sink_;
  VerifiedOutput out_;
  ByteSink keep_;  // adds bytes to out_
  std::uint32_t num_threads_ = 1;
  std::optional<SequenceCoding> coding_;
  std::optional<OrderedMeshes> meshes_;
  std::optional<StreamAssembly> stream_;  // none before the first frame
  std::optional<AttributeStage> attributes_;
  std::unique_ptr<Gof> gof_;
  std::uint32_t num_added_ = 0;
  double step_ = 0.0;           // step of the last GOF, grid steps
  StepControl control_;         // of a KG error
  double squared_error_ = 0.0;  // sum over the frames so far, of means of squared coordinates
  MetricsAccumulator metrics_;
  std::optional<InputError> failure_;
};

}  // namespace rlpc
