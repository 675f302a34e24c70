#include "encoder/codec/kinds/cluster/variant_search.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// Returns the variants that the settings leave open, the usual one first.
std::vector<BaselineTools> variants_of(const BaselineTools& tools) {
  const bool by_seeds = tools.partition == PartitionMethod::kSeeds;
  std::vector<SeedMode> seeds{tools.seed_mode};
  if (tools.seed_mode == SeedMode::kAuto) {
    seeds = {SeedMode::kTriangle};
    if (by_seeds) seeds.push_back(SeedMode::kFirst);
    seeds.push_back(SeedMode::kSpread);
  }
  std::vector<MotionMeasure> motions{tools.motion};
  if (tools.motion == MotionMeasure::kAuto && by_seeds) {
    motions = {MotionMeasure::kSquared, MotionMeasure::kPlain};
  }
  std::vector<BaselineTools> variants;
  for (const SeedMode seed_mode : seeds) {
    for (const MotionMeasure motion : motions) {
      variants.push_back(tools);
      variants.back().seed_mode = seed_mode;
      variants.back().motion = motion;
    }
  }
  return variants;
}

// Whether tools are the paper's literal method: one of the incident triangles, and distances.
bool is_literal(const BaselineTools& tools) {
  return tools.seed_mode == SeedMode::kFirst && tools.motion == MotionMeasure::kPlain;
}

struct Trial {
  ClusterChoice choice{};
  Clustering clustering;
  double error = 0.0;  // squared grid steps
  double bits = 0.0;
};

Trial encode_with(const ClusterGofCoding& coding, const EncoderSettings& settings, double step,
                  const ClusterChoice& choice) {
  const ClusterGofCoding variant(coding.mesh(), settings, coding.frames());
  Trial trial{choice, variant.cluster(*variant.cluster_maker(), choice.clusters)};
  const EncodedSpan encoded =
      variant.encode(step, variant.analyse(step, choice.world, trial.clustering));
  trial.error = squared_error(coding.frames(), encoded.frame);
  trial.bits = bits_of(encoded);
  return trial;
}

// Returns the squared error that a bit is worth: what the last component of each cluster saves,
// divided by its bits. 0 if it saves nothing.
double worth_of_bit(const ClusterGofCoding& coding, EncoderSettings settings, double step,
                    const ClusterChoice& choice, const Trial& trial) {
  const bool is_least = settings.components == 1;
  settings.components = is_least ? 2 : settings.components - 1;
  const Trial other = encode_with(coding, settings, step, choice);
  const Trial& fewer = is_least ? trial : other;
  const Trial& more = is_least ? other : trial;
  if (fewer.error <= more.error || more.bits <= fewer.bits) return 0.0;
  return (fewer.error - more.error) / (more.bits - fewer.bits);
}

}  // namespace

bool has_variants(const EncoderSettings& settings) {
  return settings.baseline.qu > 0 && variants_of(settings.baseline).size() > 1;
}

FoundVariant search_variants(const ClusterGofCoding& coding, double step,
                             std::span<const ClusterChoice> choices) {
  std::vector<Trial> trials;
  double max = std::numeric_limits<double>::infinity();
  double worth = 0.0;  // squared error per bit
  for (std::size_t i = 0; i < choices.size(); ++i) {
    for (const BaselineTools& tools : variants_of(coding.settings().baseline)) {
      EncoderSettings settings = coding.settings();
      settings.baseline = tools;
      trials.push_back(encode_with(coding, settings, step, choices[i]));
      if (i == 0 && is_literal(tools)) max = trials.back().error;
      if (trials.size() > 1) continue;
      worth = worth_of_bit(coding, settings, step, choices[i], trials.back());
    }
  }
  const auto cost = [&](const Trial& trial) {
    return trial.error > max ? std::numeric_limits<double>::infinity()
                             : trial.error + worth * trial.bits;
  };
  const auto best =
      std::min_element(trials.begin(), trials.end(),
                       [&](const Trial& a, const Trial& b) { return cost(a) < cost(b); });
  return {best->choice, std::move(best->clustering)};
}

}  // namespace rlpc
