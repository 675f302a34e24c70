// Chooses the kind of one GOF by Lagrangian cost.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_kind.h"

namespace rlpc {

// Encodes the GOF with the first kind and with each other kind that may cost less. Compares the
// kinds again when the step moves far from that of the last comparison.
class GofKindSearch : public GofCoder {
 public:
  // kinds: at least one, the most likely first. Keeps references to kinds and frames.
  GofKindSearch(const GofKinds& kinds, const GofFrames& frames, Preset preset);

  void analyse(double analysis_step) override;
  std::optional<double> expected_error(double step) const override;
  bool needs_frames(double step, double analysis_step) const override;
  EncodedGof encode(double step, double analysis_step) override;
  void release_analysis() override;

 private:
  struct Comparison {
    double step = 0.0;        // step of the last comparison
    int count = 0;            // comparisons so far
    bool is_settled = false;  // the margin was so large that other steps will not change it
  };

  bool must_compare(double step) const;
  bool may_win(const GofEncoder& kind, const EncodedGof& best, double step);
  EncodedGof compare(double step, double analysis_step);

  const GofKinds& kinds_;
  const GofFrames& frames_;
  Preset preset_;
  std::vector<std::unique_ptr<GofCoder>> coders_;  // [kind]; null: not chosen so far
  std::size_t chosen_ = 0;
  Comparison compared_;
};

}  // namespace rlpc
