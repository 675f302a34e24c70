#include "encoder/codec/kinds/cluster/cluster_gof_kind.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>

#include "encoder/codec/kinds/cluster/cluster_gof_search.h"
#include "encoder/codec/spans/split_coder.h"
#include "encoder/codec/spans/step_cache.h"

namespace rlpc {
namespace {

// tuned (off: 0): Clusters are tried only where trajectories number at least this fraction of
// their maximum. Below, one set of components for all vertices is the better basis.
constexpr double kHighRank = 0.4;

class ClusterSpanCoder : public SpanCoder {
 public:
  explicit ClusterSpanCoder(const ClusterGofCoding& coding) : coding_(coding) {}

  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return true; }
  EncodedSpan encode(double step, double analysis_step) override {
    if (!clusters_) clusters_ = search_clusters(coding_, step);
    return coding_.encode(step, analysis_.get(analysis_step, [&] {
      if (clusters_->analysis) {
        ClusterGofAnalysis analysis = std::move(*clusters_->analysis);
        clusters_->analysis.reset();
        return analysis;
      }
      return coding_.analyse(analysis_step, clusters_->choice.world, clusters_->clustering);
    }));
  }
  void release_analysis() override { analysis_.release(); }

 private:
  ClusterGofCoding coding_;
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

  bool may_win(const SpanFrames& frames, std::uint32_t components) const override {
    return components >= kHighRank * std::min(frames.num_vertices, 3 * frames.num_frames);
  }

 private:
  const SequenceMesh& mesh_;
  const EncoderSettings& settings_;
};

}  // namespace

// In the Main profile, clusters are compared with bones unless the preset is fast, the target
// is the maximum error, or any Main tool is set explicitly. The Lagrangian cost does not
// predict the maximum error, which is usually smaller with bones.
std::unique_ptr<KindEncoder> make_cluster_gof_kind(const SequenceMesh& mesh,
                                                   const EncoderSettings& settings) {
  if (settings.usable_kind() == GofKind::kCluster) {
    return std::make_unique<ClusterGofKind>(mesh, settings);
  }
  if (settings.usable_kind()) return nullptr;
  const bool suits_main = settings.preset != Preset::kFast && settings.main == MainTools{} &&
                          settings.target.kind != Target::kMaxError;
  if (settings.profile != Profile::kBaseline && !suits_main) return nullptr;
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
