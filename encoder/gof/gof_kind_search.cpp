#include "encoder/gof/gof_kind_search.h"

#include <algorithm>
#include <utility>

namespace rlpc {
namespace {

// Steps of clusters that leave about the error of bones at a step of 1.
constexpr double kStepOfClusters = 0.8;
// One PCA of all vertices does well unless it needs this part of all trajectories that can be.
constexpr double kHighRank = 0.4;
// A search for clusters is worth its time if some cost less than so many times what bones do;
// beyond the second, other steps will change nothing.
constexpr double kTryFactor = 1.1;
constexpr double kHopeless = 1.15;
constexpr std::uint32_t kVerticesOfCluster = 56;
constexpr std::uint32_t kSmallMesh = 1000;  // that one cluster, in world coordinates, may suit

}  // namespace

GofKindSearch::GofKindSearch(const SkinnedContext& bones, const ClusterContext& context,
                             const GofFrames& frames, std::uint32_t first_frame,
                             const EncoderSettings& settings, GofKindChoice& choice)
    : context_(context),
      frames_(frames),
      first_frame_(first_frame),
      settings_(settings),
      choice_(choice),
      bones_(bones, frames, first_frame, settings, choice.bones) {}

// Whether a search is worth its time: many small clusters, or one of all, come near. What is
// asked for of bones is not asked for of clusters.
bool GofKindSearch::clusters_may_win(const EncodedGof& bones, double step) {
  if (settings_.preset == Preset::kFast || settings_.main != MainTools{}) return false;
  // Costs do not tell which has the smaller largest error; mostly, it is bones.
  if (settings_.target.kind == Target::kMaxError) return false;
  if (settings_.preset == Preset::kSlow) return true;
  const std::uint32_t most = std::min(frames_.num_vertices, 3 * frames_.num_frames);
  if (bones.components < kHighRank * most) return false;
  const std::uint32_t many = std::clamp(frames_.num_vertices / kVerticesOfCluster, 2U, 96U);
  double least = cost_of_clusters({many, false}, step);
  if (frames_.num_vertices <= kSmallMesh) {
    least = std::min(least, cost_of_clusters({1, true}, step));
  }
  const double of_bones = lagrangian_cost(bones, frames_, step);
  choice_.is_settled = least > kHopeless * of_bones;
  return least < kTryFactor * of_bones;
}

double GofKindSearch::cost_of_clusters(const ClusterChoice& clusters, double step) const {
  std::optional<ClusterChoice> none;
  ClusterGofSearch search(context_, frames_, first_frame_, settings_, none);
  return lagrangian_cost(search.encode_once(kStepOfClusters * step, clusters), frames_, step);
}

EncodedGof GofKindSearch::encode_clusters(double step, double analysis_step) {
  if (!clusters_) {
    clusters_.emplace(context_, frames_, first_frame_, settings_, choice_.clusters);
  }
  return clusters_->encode(kStepOfClusters * step, kStepOfClusters * analysis_step);
}

void GofKindSearch::analyse(double analysis_step) {
  if (!choice_.has_clusters) bones_.analyse(analysis_step);
}

std::optional<double> GofKindSearch::expected_error(double step) const {
  if (choice_.has_clusters) return std::nullopt;
  return bones_.expected_error(step);
}

bool GofKindSearch::needs_frames(double step, double analysis_step) const {
  return choice_.is_far(analysis_step) || choice_.has_clusters ||
         bones_.needs_frames(step, analysis_step);
}

EncodedGof GofKindSearch::encode(double step, double analysis_step) {
  if (!choice_.is_far(analysis_step)) {
    return choice_.has_clusters ? encode_clusters(step, analysis_step)
                                : bones_.encode(step, analysis_step);
  }
  choice_.step = analysis_step;
  ++choice_.times;
  choice_.has_clusters = false;
  EncodedGof bones = bones_.encode(step, analysis_step);
  if (!clusters_may_win(bones, step)) return bones;
  choice_.clusters.reset();
  clusters_.reset();
  EncodedGof clusters = encode_clusters(step, analysis_step);
  choice_.has_clusters =
      lagrangian_cost(clusters, frames_, step) < lagrangian_cost(bones, frames_, step);
  return choice_.has_clusters ? std::move(clusters) : std::move(bones);
}

}  // namespace rlpc
