// Encodes frames that arrive one by one, span by span.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "encoder/codec/frame_format.h"
#include "encoder/codec/sequence/attribute_stage.h"
#include "encoder/codec/sequence/choices/gof_cuts.h"
#include "encoder/codec/sequence/choices/level_choice.h"
#include "encoder/codec/sequence/frame_backend.h"
#include "encoder/codec/sequence/sequence_coding.h"
#include "encoder/codec/sequence/span_batch.h"
#include "encoder/codec/sequence/span_buffer.h"
#include "encoder/codec/sequence/stream_assembly.h"
#include "encoder/codec/sequence/target_loop.h"
#include "encoder/codec/sequence/verified_output.h"

namespace rlpc {

class SpanEncoder final : public FrameBackend {
 public:
  SpanEncoder(FrameFormat format, EncoderSettings settings, ByteSink sink)
      : format_(std::move(format)),
        settings_(std::move(settings)),
        sink_(std::move(sink)),
        out_(settings_, format_.num_frames == 0),
        coded_(format_.num_vertices) {}

  std::optional<InputError> prepare() override;
  std::optional<InputError> add_frame(std::span<const float> xyz,
                                      std::span<const double> exact) override;
  InputResult<EncodeReport> finish() override;
  std::uint32_t num_added() const override { return num_added_; }

 private:
  // The results of all spans so far.
  struct Coded {
    explicit Coded(std::uint32_t num_vertices)
        : metrics(num_vertices, MetricsAccumulator::kTotals) {}

    std::size_t spans = 0;
    double step = 0.0;  // step of the last span, grid steps; 0: none yet
    MetricsAccumulator metrics;
    std::vector<MetricsAccumulator> cuts;  // [temporal layers - 1]
    EncodeReport report;
  };

  void make_spans(const SequenceHeader& header);
  bool is_open_ended() const { return format_.num_frames == 0; }
  // Returns the span that is being filled or encoded.
  FrameRange current() const;
  std::optional<InputError> encode_span();
  std::optional<InputError> write(const SpanResult& span);
  void use_header(const SequenceHeader& header);
  // Returns the header with the grid for errors of `finest` (units) and more.
  SequenceHeader header_for(double finest) const;
  InputResult<TargetResult> search(const FrameRange& span, double rms_spread);
  InputResult<TargetResult> search_first(const FrameRange& span, double rms_spread);
  std::optional<InputError> keep_to_level(const LevelNeeds& needs);
  double fixed_bits_per_frame() const;
  InputError fail(InputError error) {
    failure_ = error;
    return error;
  }

  FrameFormat format_;
  EncoderSettings settings_;
  ByteSink sink_;
  VerifiedOutput out_;
  std::vector<FrameRange> spans_;
  std::optional<SequenceCoding> coding_;
  std::optional<StreamAssembly> stream_;  // none before the first span
  std::optional<AttributeStage> attributes_;
  std::optional<SpanBuffer> buffer_;
  std::shared_ptr<const KeptRig> rig_;  // in force after the last span; null: none
  std::uint32_t num_added_ = 0;
  std::uint32_t num_held_ = 0;  // frames in the buffer
  std::uint32_t longest_gof_ = 0;
  std::uint32_t num_threads_ = 1;
  Coded coded_;
  std::optional<InputError> failure_;
};

}  // namespace rlpc
