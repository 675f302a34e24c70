#include "encoder/cluster_gof/cluster_gof_kind.h"

#include <algorithm>
#include <optional>

#include "encoder/cluster_gof/cluster_gof_search.h"
#include "encoder/gof/lagrangian.h"
#include "encoder/gof/step_cache.h"

namespace rlpc {
namespace {

constexpr double kStepOfClusters = 0.8;  // tuned (off: 1): leaves about the error of bones
// One PCA of all vertices does well unless it needs this part of all trajectories that can be.
constexpr double kHighRank = 0.4;  // tuned (off: 0): below, clusters are not tried
constexpr std::uint32_t kVerticesOfCluster = 56;  // tuned: of many small ones, as a sample
constexpr std::uint32_t kFewestClusters = 2;      // fixed: of many
constexpr std::uint32_t kMostClusters = 96;       // fixed: the most that are searched
constexpr std::uint32_t kSmallMesh =
    1000;  // tuned (off: 0): vertices that one cluster may suit

class ClusterGofCoder : public GofCoder {
 public:
  ClusterGofCoder(const ClusterGofCoding& coding, double step_factor)
      : coding_(coding), step_factor_(step_factor) {}

  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return true; }
  EncodedGof encode(double step, double analysis_step) override {
    step *= step_factor_;
    analysis_step *= step_factor_;
    if (!clusters_) clusters_ = search_clusters(coding_, step);
    return coding_.encode(step, analysis_.get(analysis_step, [&] {
      return coding_.analyse(analysis_step, clusters_->choice.world, clusters_->clustering);
    }));
  }
  void release_analysis() override { analysis_.release(); }

 private:
  ClusterGofCoding coding_;
  double step_factor_;
  std::optional<FoundClusters> clusters_;
  StepCache<ClusterGofAnalysis> analysis_;
};

class ClusterGofKind : public GofEncoder {
 public:
  ClusterGofKind(const SequenceMesh& mesh, const EncoderSettings& settings)
      : mesh_(mesh),
        settings_(settings),
        step_factor_(settings.profile == Profile::kMain ? kStepOfClusters : 1.0) {}

  std::unique_ptr<GofCoder> make_coder(const GofFrames& frames) const override {
    return std::make_unique<ClusterGofCoder>(ClusterGofCoding(mesh_, settings_, frames),
                                             step_factor_);
  }

  // Of many small clusters or, of a small mesh, one of all.
  std::optional<double> estimate_cost(const GofFrames& frames, const EncodedGof& best,
                                      double step) const override {
    const std::uint32_t most = std::min(frames.num_vertices, 3 * frames.num_frames);
    if (best.components < kHighRank * most) return std::nullopt;
    const ClusterGofCoding coding(mesh_, settings_, frames);
    const auto cost = [&](const ClusterChoice& choice) {
      MotionClusters motion = coding.motion();
      return lagrangian_cost(coding.encode(step_factor_ * step, choice, motion), frames, step);
    };
    double least = cost(
        {std::clamp(frames.num_vertices / kVerticesOfCluster, kFewestClusters, kMostClusters),
         false});
    if (frames.num_vertices <= kSmallMesh) least = std::min(least, cost({1, true}));
    return least;
  }

 private:
  const SequenceMesh& mesh_;
  const EncoderSettings& settings_;
  double step_factor_;
};

}  // namespace

// In the Main profile, only where there is time to compare. Costs do not tell which kind has
// the smaller largest error; usually, it is bones. What is asked for of these is not asked for
// of clusters.
std::unique_ptr<GofEncoder> make_cluster_gof_kind(const SequenceMesh& mesh,
                                                  const EncoderSettings& settings) {
  const bool suits_main = settings.preset != Preset::kFast && settings.main == MainTools{} &&
                          settings.target.kind != Target::kMaxError;
  if (settings.profile == Profile::kMain && !suits_main) return nullptr;
  return std::make_unique<ClusterGofKind>(mesh, settings);
}

std::unique_ptr<GofEncoder> make_last_resort(const SequenceMesh& mesh,
                                             const EncoderSettings& settings) {
  if (settings.profile != Profile::kMain || settings.main != MainTools{}) return nullptr;
  return std::make_unique<ClusterGofKind>(mesh, settings);
}

}  // namespace rlpc
