// One GOF of the Main profile: bones, or clusters where these cost less.
#pragma once

#include <cstdint>
#include <optional>

#include "encoder/cluster_gof/cluster_gof_search.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/skinned_gof/search/skinned_gof_search.h"

namespace rlpc {

struct GofKindChoice {
  std::optional<SkinnedChoice> bones;
  std::optional<ClusterChoice> clusters;  // if these are better, or may be
  bool has_clusters = false;
  double step = 0.0;        // that bones and clusters were compared for
  int times = 0;            // that they were
  bool is_settled = false;  // so clearly that other steps will change nothing

  // Whether they should be compared for a step.
  bool is_far(double other) const {
    constexpr double kFar = 1.25;
    constexpr int kMostTimes = 4;
    if (times == 0) return true;
    return !is_settled && times < kMostTimes && (other > kFar * step || other * kFar < step);
  }
};

class GofKindSearch : public GofCoder {
 public:
  // All but the number are kept by reference. choice: that of an earlier search of the same
  // GOF, or none.
  GofKindSearch(const SkinnedContext& bones, const ClusterContext& context,
                const GofFrames& frames, std::uint32_t first_frame,
                const EncoderSettings& settings, GofKindChoice& choice);

  void analyse(double analysis_step) override;
  std::optional<double> expected_error(double step) const override;
  bool needs_frames(double step, double analysis_step) const override;
  EncodedGof encode(double step, double analysis_step) override;

 private:
  bool clusters_may_win(const EncodedGof& bones, double step);
  double cost_of_clusters(const ClusterChoice& clusters, double step) const;
  EncodedGof encode_clusters(double step, double analysis_step);

  const ClusterContext& context_;
  const GofFrames& frames_;
  std::uint32_t first_frame_;
  const EncoderSettings& settings_;
  GofKindChoice& choice_;
  SkinnedGofSearch bones_;
  std::optional<ClusterGofSearch> clusters_;
};

}  // namespace rlpc
