// The choice of a kind for one GOF, by Lagrangian cost.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_kind.h"

namespace rlpc {

// Encodes the GOF by the first kind, and by each further one that may cost less. Where steps
// move far from the one that kinds were compared for, they are compared again.
class GofKindSearch : public GofCoder {
 public:
  // kinds: at least one, the likeliest first. Kinds and frames are kept by reference.
  GofKindSearch(const GofKinds& kinds, const GofFrames& frames, Preset preset);

  void analyse(double analysis_step) override;
  std::optional<double> expected_error(double step) const override;
  bool needs_frames(double step, double analysis_step) const override;
  EncodedGof encode(double step, double analysis_step) override;
  void release_analysis() override;

 private:
  struct Comparison {
    double step = 0.0;        // that kinds were compared for
    int times = 0;            // that they were
    bool is_settled = false;  // so clearly that other steps will change nothing
  };

  bool is_far(double step) const;
  bool may_win(const GofEncoder& kind, const EncodedGof& best, double step);
  EncodedGof compare(double step, double analysis_step);

  const GofKinds& kinds_;
  const GofFrames& frames_;
  Preset preset_;
  std::vector<std::unique_ptr<GofCoder>> coders_;  // [kind]; null: not needed so far
  std::size_t chosen_ = 0;
  Comparison compared_;
};

}  // namespace rlpc
