// Encodes a span whose GOFs share nothing, each with a coder of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

class SplitCoder : public SpanCoder {
 public:
  using MakeCoder = std::function<std::unique_ptr<SpanCoder>(const SpanFrames& frames)>;

  // make: makes the coder of a GOF, which keeps a reference to its frames. Keeps a reference to
  // the frames of the span.
  SplitCoder(const SpanFrames& frames, const MakeCoder& make);

  bool needs_frames(double step, double analysis_step) const override;
  EncodedSpan encode(double step, double analysis_step) override;
  void release_analysis() override;
  void keep_num_components() override;
  // Asks the coders of at most two GOFs.
  std::optional<double> step_in_reach(double step, const SpanCost& rival) override;

 private:
  struct Part {
    SpanFrames frames;  // empty unless it is being encoded
    std::unique_ptr<SpanCoder> coder;
  };

  const SpanFrames& frames_;
  std::vector<std::unique_ptr<Part>> parts_;
};

// Returns the frames of a GOF of a span.
SpanFrames frames_in_gof(const SpanFrames& frames, const FrameRange& gof);

}  // namespace rlpc
