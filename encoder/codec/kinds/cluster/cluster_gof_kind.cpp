#include "encoder/codec/kinds/cluster/cluster_gof_kind.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "encoder/codec/kinds/cluster/cluster_gof_search.h"
#include "encoder/codec/kinds/cluster/cluster_sample.h"
#include "encoder/codec/spans/lagrangian.h"
#include "encoder/codec/spans/split_coder.h"
#include "encoder/codec/spans/step_cache.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {
namespace {

// tuned (off: 0): Estimates above the rival by less than this factor may be wrong.
constexpr double kMargin = 1.15;

class ClusterSpanCoder : public SpanCoder {
 public:
  explicit ClusterSpanCoder(const ClusterGofCoding& coding) : coding_(coding) {}

  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return true; }
  std::optional<double> step_in_reach(double step, const SpanCost& rival) override {
    const Stage stage("cluster GOFs");
    if (!uses_sample()) return step;
    const ClusterSample sample(coding_.mesh(), coding_.settings(), coding_.frames());
    const ClusterSample::Estimate estimate = sample.cheapest(step, rival);
    choice_ = estimate.choice;
    if (ratio_at_equal_error(estimate.cost, rival) > kMargin) return std::nullopt;
    return step;
  }
  EncodedSpan encode(double step, double analysis_step) override {
    const Stage stage("cluster GOFs");
    if (!clusters_) {
      clusters_ = choice_ ? search_clusters_near(coding_, step, *choice_)
                          : search_clusters(coding_, step);
    }
    return coding_.encode(step, analysis_.get(analysis_step, [&] {
      return coding_.analyse(analysis_step, clusters_->choice.world, clusters_->clustering);
    }));
  }
  void release_analysis() override { analysis_.release(); }

 private:
  bool uses_sample() const {
    const BaselineTools& tools = coding_.settings().baseline;
    return tools.clusters == 0 && tools.frame_mode == FrameMode::kAuto;
  }

  ClusterGofCoding coding_;
  std::optional<ClusterChoice> choice_;  // by a sample of the mesh
  std::optional<FoundClusters> clusters_;
  StepCache<ClusterGofAnalysis> analysis_;
};

class ClusterGofKind : public KindEncoder {
 public:
  ClusterGofKind(const SequenceMesh& mesh, const EncoderSettings& settings)
      : mesh_(mesh), settings_(settings) {}

  std::unique_ptr<SpanCoder> make_coder(const SpanFrames& frames) const override {
    if (frames.num_gofs > 1) {
      return std::make_unique<SplitCoder>(
          frames, [this](const SpanFrames& gof_frames) { return make_coder(gof_frames); });
    }
    return std::make_unique<ClusterSpanCoder>(ClusterGofCoding(mesh_, settings_, frames));
  }

 private:
  const SequenceMesh& mesh_;
  const EncoderSettings& settings_;
};

}  // namespace

// In the Main and High profiles, clusters are compared with bones unless any Main tool is set
// explicitly.
std::unique_ptr<KindEncoder> make_cluster_gof_kind(const SequenceMesh& mesh,
                                                   const EncoderSettings& settings) {
  if (settings.usable_kind() == GofKind::kCluster) {
    return std::make_unique<ClusterGofKind>(mesh, settings);
  }
  if (settings.usable_kind()) return nullptr;
  if (settings.profile != Profile::kBaseline && settings.main != MainTools{}) return nullptr;
  return std::make_unique<ClusterGofKind>(mesh, settings);
}

std::unique_ptr<KindEncoder> make_last_resort(const SequenceMesh& mesh,
                                              const EncoderSettings& settings) {
  if (settings.profile == Profile::kBaseline || settings.main != MainTools{} ||
      settings.usable_kind()) {
    return nullptr;
  }
  return std::make_unique<ClusterGofKind>(mesh, settings);
}

}  // namespace rlpc
