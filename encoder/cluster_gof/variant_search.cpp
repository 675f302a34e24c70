#include "encoder/cluster_gof/variant_search.h"

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/gof/lagrangian.h"

namespace rlpc {
namespace {

// The variants that the settings leave open, the usual one first.
std::vector<BaselineTools> variants_of(const BaselineTools& tools) {
  const bool by_seeds = tools.partition == PartitionMethod::kSeeds;
  std::vector<SeedMode> seeds{tools.seed_mode};
  if (tools.seed_mode == SeedMode::kAuto) {
    seeds = {SeedMode::kTriangle};
    if (by_seeds) seeds.push_back(SeedMode::kFirst);
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

// The paper as it reads: one of the incident triangles, and distances.
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
  const EncodedGof encoded =
      variant.encode(step, variant.analyse(step, choice.world, trial.clustering));
  trial.error = squared_error(coding.frames(), encoded.frame);
  trial.bits = bits_of(encoded);
  return trial;
}

// The squared error that a bit is worth: what the last component of each cluster saves, divided
// by what it takes. 0 if it saves nothing.
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
  std::optional<Trial> best;
  double worth = 0.0;  // of a bit
  for (const ClusterChoice& choice : choices) {
    std::vector<Trial> trials;
    double most = std::numeric_limits<double>::infinity();
    for (const BaselineTools& tools : variants_of(coding.settings().baseline)) {
      EncoderSettings settings = coding.settings();
      settings.baseline = tools;
      trials.push_back(encode_with(coding, settings, step, choice));
      if (is_literal(tools)) most = trials.back().error;
      if (best || trials.size() > 1) continue;
      worth = worth_of_bit(coding, settings, step, choice, trials.back());
    }
    for (Trial& trial : trials) {
      if (trial.error > most) continue;
      const bool is_better =
          !best || trial.error + worth * trial.bits < best->error + worth * best->bits;
      if (is_better) best = std::move(trial);
    }
  }
  return {best->choice, std::move(best->clustering)};
}

}  // namespace rlpc
