// Chooses the kind of one GOF by Lagrangian cost.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/codec/spans/gof_coder.h"
#include "encoder/codec/spans/gof_kind.h"

namespace rlpc {

// Encodes the GOF by the first kind and, on other threads, by each that may cost less. The
// choice stands for further steps: comparing again where these move far gains 0.1 % for a fifth
// more time.
class GofKindSearch : public GofCoder {
 public:
  // kinds: at least one, the most likely first. Keeps references to kinds and frames.
  GofKindSearch(const GofKinds& kinds, const GofFrames& frames, Preset preset);

  // That of the most likely kind.
  void set_progress(const Progress& progress) override;
  void analyse(double analysis_step) override;
  std::optional<double> expected_error(double step) const override;
  bool needs_frames(double step, double analysis_step) const override;
  EncodedGof encode(double step, double analysis_step) override;
  void release_analysis() override;

 private:
  bool must_compare() const { return kinds_.size() > 1 && !is_compared_; }
  EncodedGof compare(double step, double analysis_step);

  const GofKinds& kinds_;
  const GofFrames& frames_;
  Preset preset_;
  std::vector<std::unique_ptr<GofCoder>> coders_;  // [kind]; null: not chosen so far
  std::size_t chosen_ = 0;
  bool is_compared_ = false;
};

}  // namespace rlpc
