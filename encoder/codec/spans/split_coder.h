// Encodes a span whose GOFs share nothing: each by a coder of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/codec/spans/gof_coder.h"
#include "encoder/codec/spans/gof_frames.h"

namespace rlpc {

class SplitCoder : public GofCoder {
 public:
  using MakeCoder = std::function<std::unique_ptr<GofCoder>(const GofFrames& frames)>;

  // make: of the coder of a GOF, which keeps a reference to its frames. Keeps a reference to
  // the frames of the span.
  SplitCoder(const GofFrames& frames, const MakeCoder& make);

  bool needs_frames(double step, double analysis_step) const override;
  EncodedGof encode(double step, double analysis_step) override;
  void release_analysis() override;

 private:
  struct Part {
    GofFrames frames;  // only while it is encoded
    std::unique_ptr<GofCoder> coder;
  };

  const GofFrames& frames_;
  std::vector<std::unique_ptr<Part>> parts_;
};

// The frames of a GOF of a span.
GofFrames frames_of_gof(const GofFrames& frames, const GofSpan& gof);

}  // namespace rlpc
