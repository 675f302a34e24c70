#include "encoder/codec/kinds/inter/inter_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "encoder/codec/partition/partition.h"
#include "encoder/codec/spans/layer_groups.h"

namespace rlpc {
namespace {

// tuned (off: 0): Binary logarithm of the damping of the geometry weights, 8.11, from which
// learned weights start.
constexpr int kFrameDamping = 6;
// tuned (off: 0): The weight of near vertices, 1/16. Learned weights barely depend on it;
// without learning, frames take 1 to 7 % more bytes if it is 0.
constexpr int kNearWeight = 3;
// tuned (off: 0): How much the weights of near vertices change, 1/16.
constexpr int kNearScale = 3;
// tuned (off: 0): Binary logarithm of the variance with which weights are first learned from
// the first frame, whose offsets then have 10 bits.
constexpr int kPrime = 6;

// tuned (off: 1): Growth of the quantiser step from one depth of a pattern to the next. Deeper
// frames are no references, so that their errors stay with them.
constexpr double kStepOfDepth = 1.2;

// tuned (off: 1): The step of the first frame, in steps of depth 0. All others inherit its
// errors.
constexpr double kStepOfFirst = 0.5;
// tuned (off: 1): The step of a layer, in steps of the next finer one, which inherits its
// errors.
constexpr double kStepOfLayer = 0.97;
// fixed: a guard; no layer has a smaller step than this, relative to the finest.
constexpr double kMinLayerStep = 0.5;

// Returns the root mean square of the steps of a period, in steps of depth 0.
double mean_step(const FramePattern& pattern) {
  const FrameOrder order(pattern, pattern.period() + 1);
  double sum = 0.0;
  for (std::uint32_t place = 1; place < order.num_frames(); ++place) {
    double step = 1.0;
    for (std::uint32_t d = 0; d < order[place].depth; ++d) step *= kStepOfDepth;
    sum += step * step;
  }
  return std::sqrt(sum / pattern.period());
}

void set_layer_steps(Vector<std::uint8_t>& steps) {
  double step = 1.0;
  for (std::size_t l = steps.size(); l-- > 0; step *= kStepOfLayer) {
    steps[l] =
        static_cast<std::uint8_t>(std::lround(kMaxLayerStep * std::max(step, kMinLayerStep)));
  }
}

}  // namespace

ResidualRule residual_rule(const EncoderSettings& settings, const FramePattern& pattern) {
  const Target::Kind target = settings.target.kind;
  if (target == Target::kMaxError && settings.low_delay) return ResidualRule::kNearest;
  const bool may_follow = target != Target::kMaxError && target != Target::kLossless;
  return may_follow && pattern.num_depths() == 1 ? ResidualRule::kFollowRing
                                                 : ResidualRule::kCheapest;
}

InterSettings choose_frame_settings(const SequenceHeader& header,
                                    const EncoderSettings& settings, const OrderedMesh& layers,
                                    const FramePattern& pattern, double step) {
  InterSettings s;
  s.pattern = pattern;
  s.pattern.temporal_layers = settings.inter.temporal_layers;
  step /= mean_step(s.pattern);
  const auto units = [](double wanted) {
    return static_cast<std::uint32_t>(
        std::clamp(std::floor(wanted * kExactInterStep + 0.5), 1.0, double{kMaxInterStep}));
  };
  s.exact_flag = settings.target.kind == Target::kLossless;
  s.step.assign(s.pattern.num_depths(), kExactInterStep);
  const bool is_bound = settings.target.kind == Target::kMaxError;
  if (!s.exact_flag) s.first_step = units(is_bound ? step : kStepOfFirst * step);
  for (std::uint32_t& depth_step : s.step) {
    if (s.exact_flag) break;
    depth_step = units(step);
    step *= kStepOfDepth;
  }
  const InterWeights weights = settings.inter.weights;
  s.weights = {kFrameDamping, kNearWeight, kNearScale, 0};
  if (weights == InterWeights::kPlain) s.weights = {};
  const std::uint64_t filters = std::uint64_t{header.num_vertices} * s.pattern.temporal_layers;
  s.learning_flag =
      weights == InterWeights::kLearned && filters <= header.level().max_learning_vertices;
  s.prime_log2 = s.learning_flag ? kPrime : 0;
  s.frame_hash_flag =
      (header.open_end_flag || settings.low_delay) && settings.hash_mode != HashMode::kNone;
  s.layer_group_size =
      layer_group_sizes(layers, settings.inter.layer_groups, settings.inter.layer_cuts);
  s.layer_step.assign(layers.num_layers(), kMaxLayerStep);
  if (!s.exact_flag && !is_bound) set_layer_steps(s.layer_step);
  return s;
}

PatchOfVertex divide_into_patches(const SequenceHeader& header, const EncoderSettings& settings,
                                  const SpanFrames& frames, std::span<const Triangle> triangles,
                                  std::uint32_t count) {
  const std::uint32_t max = std::min(count, header.level().max_clusters);
  if (max == 0) return {};
  return partition_vertices(settings.inter.partition, frames, triangles, max);
}

void set_patches(InterSettings& settings, const PatchOfVertex& patch_of_vertex) {
  settings.patch_of_vertex = patch_of_vertex;
  settings.num_patches = num_parts(patch_of_vertex);
}

}  // namespace rlpc
