#include "encoder/codec/kinds/skinned/search/tool_search.h"

#include <atomic>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "common/parallel/for_each.h"

namespace rlpc {
namespace {

// tuned (off: 0): Meshes of at most this many vertices are encoded with every prediction along
// the mesh, as with the slow preset. Parallelograms predict some of them much better than
// layers, and the time is short.
constexpr std::uint32_t kSmallMesh = 1000;

// Changes settings. Returns false if they had these values before.
using Change = std::function<bool(SkinnedSettings&)>;

template <class T>
Change set(T SkinnedSettings::*member, T value) {
  return [=](SkinnedSettings& settings) {
    return std::exchange(settings.*member, value) != value;
  };
}

// Geometry weights do not pay off if the rest positions say little about the motion.
// Parallelograms predict small regular meshes better. If the residual of bone motion is small,
// rest positions cost less without layers.
std::vector<Change> changes(const SkinnedContext& context, const SkinnedCandidate& candidate) {
  const MainTools& tools = context.settings.main;
  const bool thorough =
      context.settings.preset == Preset::kSlow || context.header.num_vertices <= kSmallMesh;
  std::vector<Change> list;
  if (candidate.settings.prediction == Prediction::kLayers) {
    if (tools.geometry_weights) list.push_back(set(&SkinnedSettings::damping_log2, 0));
    if (tools.layer_steps && thorough) {
      list.push_back(set(&SkinnedSettings::layer_steps, false));
    }
  }
  const auto predict = [&](Prediction prediction) {
    list.push_back(set(&SkinnedSettings::prediction, prediction));
  };
  const bool any_prediction = !tools.prediction && tools.layer_groups <= 1;
  if (any_prediction && candidate.rig.bones.size() > 1) predict(Prediction::kNone);
  if (any_prediction && thorough) {
    predict(Prediction::kParallelogram);
    predict(Prediction::kParallelograms);
  }
  return list;
}

// Returns the trial with only the largest trajectories, which show the gain of tools.
SkinnedTrial with_few(const SkinnedTrials& trials, const SkinnedTrial& best) {
  // tuned (off: 1e9): Trajectories with which tools are compared.
  constexpr std::size_t kFew = 32;
  if (best.num_trajectories <= 2 * kFew) return best;
  SkinnedSettings settings = best.candidate.settings;
  settings.max_trajectories = kFew;
  return trials.again(best, settings);
}

}  // namespace

// Tries one change after another, each on the best so far. Threads try changes ahead: those
// after a change that wins are tried again.
SkinnedTrial search_tools(const SkinnedContext& context, const SkinnedTrials& trials,
                          SkinnedTrial start) {
  const std::vector<Change> list = changes(context, start.candidate);
  if (list.empty()) return start;
  SkinnedTrial best = with_few(trials, start);
  bool changed = false;
  std::size_t first = 0;
  while (first < list.size()) {
    std::vector<BestTrial> cheaper_by(list.size());
    std::atomic<std::size_t> winner = list.size();  // the first winning change so far
    for_each(list.size() - first, [&](std::size_t i) {
      const std::size_t k = first + i;
      SkinnedSettings other = best.candidate.settings;
      if (k > winner || !list[k](other)) return;
      cheaper_by[k] = trials.with_settings(best, other);
      for (std::size_t now = winner;
           cheaper_by[k] && k < now && !winner.compare_exchange_weak(now, k);) {
      }
    });
    first = winner;
    if (first < list.size()) {
      best = std::move(*cheaper_by[first++]);
      changed = true;
    }
  }
  if (!changed) return start;
  SkinnedSettings settings = best.candidate.settings;
  if (settings.max_trajectories == start.candidate.settings.max_trajectories) return best;
  settings.max_trajectories = start.candidate.settings.max_trajectories;
  return trials.again(best, settings);
}

}  // namespace rlpc
