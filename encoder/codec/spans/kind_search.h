// Chooses the kind of one GOF by Lagrangian cost.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/codec/spans/kind_encoder.h"
#include "encoder/codec/spans/span_coder.h"

namespace rlpc {

// Encodes the GOF by the first kind, then by each that may cost less than the best so far. The
// choice holds for further steps: comparing again where these move far gains 0.1 % for a fifth
// more time.
class KindSearch : public SpanCoder {
 public:
  // kinds: at least one, the most likely first. Keeps references to kinds and frames.
  KindSearch(const KindEncoders& kinds, const SpanFrames& frames, Preset preset);

  // Sets the progress function of the most likely kind.
  void set_progress(const Progress& progress) override;
  void analyse(double analysis_step) override;
  std::optional<double> expected_error(double step) const override;
  bool needs_frames(double step, double analysis_step) const override;
  EncodedSpan encode(double step, double analysis_step) override;
  void release_analysis() override;
  void keep_num_components() override { coders_[chosen_]->keep_num_components(); }
  bool is_contested() const override { return is_contested_; }

 private:
  bool must_compare() const { return kinds_.size() > 1 && !is_compared_; }
  EncodedSpan compare(double step, double analysis_step);

  const KindEncoders& kinds_;
  const SpanFrames& frames_;
  Preset preset_;
  std::vector<std::unique_ptr<SpanCoder>> coders_;  // [kind]; null: not chosen yet
  std::size_t chosen_ = 0;
  bool is_compared_ = false;
  bool is_contested_ = false;
};

}  // namespace rlpc
