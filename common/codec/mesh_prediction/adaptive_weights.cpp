#include "common/codec/mesh_prediction/adaptive_weights.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>

#include "common/codec/bits/int_math.h"
#include "common/codec/components/component_limits.h"

namespace rlpc {
namespace {

static_assert(kMaxRing + kMaxOuterRing <= kMaxFilterSize);

// DivRound( x, n ) for 1 < n <= kMaxRing and |x| <= n * 2^23, by multiplication.
class MeanOf {
 public:
  explicit MeanOf(std::size_t n)
      : half_(static_cast<std::int64_t>(n) + 2 * kBias * static_cast<std::int64_t>(n)),
        inverse_(inverse_of(n)) {}
  // floor((2x + n) / 2n): the numerator is made positive, and is below 2^28. The inverse is too
  // large by at most 1 / 2^35, the quotient therefore by less than 2^28 / 2^35 < 1 / 2n.
  std::int32_t operator()(std::int32_t x) const {
    const auto numerator = static_cast<std::uint64_t>(2 * std::int64_t{x} + half_);
    return static_cast<std::int32_t>((numerator * inverse_) >> kShift) -
           static_cast<std::int32_t>(kBias);
  }

 private:
  static constexpr int kShift = 35;
  static constexpr std::int64_t kBias = std::int64_t{1} << (kMaxSpatialBits - 1);
  static std::uint64_t inverse_of(std::size_t n) {
    assert(n > 1);
    return (std::uint64_t{1} << kShift) / (2 * n) + 1;
  }
  std::int64_t half_;
  std::uint64_t inverse_;
};

}  // namespace

AdaptiveWeights::AdaptiveWeights(const OrderedMesh& mesh, const GeometryWeights& weights,
                                 const WeightSettings& settings,
                                 const std::array<std::span<const std::int32_t>, 3>& rest)
    : mesh_(mesh),
      rest_(rest),
      adapt_to_rest_(settings.damping_log2 > 0),
      num_adaptive_factors_(settings.num_adaptive_factors),
      first_(std::size_t{mesh.num_vertices()} + 1, 0) {
  weights_.reserve(weights.size());
  constexpr std::int64_t kFiner = 1 << (kAdaptiveFractionBits - kWeightFractionBits);
  for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
    for (const std::int32_t w : weights[v]) {
      weights_.push_back(static_cast<std::int32_t>(
          clip3(-kMaxAdaptiveWeight, kMaxAdaptiveWeight, w * kFiner)));
    }
    first_[v + 1] = static_cast<std::uint32_t>(weights_.size());
  }
}

void AdaptiveWeights::start(std::size_t first, std::size_t count,
                            std::span<const std::size_t> group_end) {
  is_first_ = first == 0;
  count_ = count;
  adaptive_count_ =
      std::min(count, num_adaptive_factors_ - std::min(first, num_adaptive_factors_));
  group_end_ = group_end;
}

VertexAdaptation::VertexAdaptation(AdaptiveWeights& weights)
    : weights_(weights), kernels_(kernels().back()) {}

// 8.15.1 Initialisation
bool VertexAdaptation::start(std::uint32_t v, std::span<const std::int32_t> values) {
  const auto ring = weights_.mesh_.ring(v);
  if (ring.size() < 2) return false;
  const auto outer_ring = weights_.mesh_.outer_ring(v);
  vertex_ = v;
  ring_size_ = ring.size();
  next_ = 0;
  neighbours_.assign(ring.begin(), ring.end());
  neighbours_.insert(neighbours_.end(), outer_ring.begin(), outer_ring.end());
  filter_.start(std::span(weights_.weights_)
                    .subspan(weights_.first_[v], weights_.first_[v + 1] - weights_.first_[v]),
                ring_size_, weights_.is_first_ ? kSpreadShift : kLaterSpreadShift);
  if (weights_.is_first_ && weights_.adapt_to_rest_) adapt_to_rest();
  gather(values);
  return true;
}

// 8.15.1 AdaptToRest( v )
void VertexAdaptation::adapt_to_rest() {
  std::array<std::array<std::int64_t, kMaxFilterSize>, 3> offset{};
  Vec3l gap{};
  std::int64_t largest = 1;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& rest = weights_.rest_[c];
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < ring_size_; ++i) sum += rest[neighbours_[i]];
    const std::int64_t mean = div_round(sum, static_cast<std::int64_t>(ring_size_));
    gap[c] = rest[vertex_] - mean;
    largest = std::max(largest, std::abs(gap[c]));
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      offset[c][i] = rest[neighbours_[i]] - mean;
      largest = std::max(largest, std::abs(offset[c][i]));
    }
  }
  const int shift = floor_log2(static_cast<std::uint64_t>(largest)) - kOffsetLog2;
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<std::int32_t, kMaxFilterSize> shifted{};
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      shifted[i] = static_cast<std::int32_t>(shift_by(offset[c][i], shift));
    }
    const std::int64_t error =
        shift_by(gap[c], shift) - kernels_.predict_offset(filter_.state(), shifted.data());
    kernels_.adapt(filter_.state(), shifted.data(), error);
  }
}

// 8.15.2 NeighbourOffsets( v, values ), for all factors of the group
void VertexAdaptation::gather(std::span<const std::int32_t> values) {
  const std::size_t count = weights_.count_;
  const std::size_t stride = filter_.stride;
  mean_.assign(count, 0);
  offsets_.assign(count * stride, 0);
  for (std::size_t i = 0; i < ring_size_; ++i) {
    const std::int32_t* const from = &values[neighbours_[i] * count];
    for (std::size_t k = 0; k < count; ++k) mean_[k] += from[k];
  }
  const MeanOf mean_of(ring_size_);
  for (std::int32_t& x : mean_) x = mean_of(x);
  for (std::size_t i = 0; i < neighbours_.size(); ++i) {
    const std::int32_t* const from = &values[neighbours_[i] * count];
    for (std::size_t k = 0; k < count; ++k) offsets_[k * stride + i] = from[k] - mean_[k];
  }
}

std::int64_t VertexAdaptation::predict() {
  return mean_[next_] +
         kernels_.predict_offset(filter_.state(), &offsets_[next_ * filter_.stride]);
}

void VertexAdaptation::add(std::int64_t prediction, std::int32_t value) {
  if (next_ < weights_.adaptive_count_) {
    kernels_.adapt(filter_.state(), &offsets_[next_ * filter_.stride], value - prediction);
  }
  ++next_;
  const auto& ends = weights_.group_end_;
  if (next_ < weights_.adaptive_count_ &&
      std::find(ends.begin(), ends.end(), next_) != ends.end()) {
    const std::array<std::int32_t, kMaxFilterSize> weight = filter_.weight;
    filter_.start(std::span(weight).first(filter_.size), ring_size_, kLaterSpreadShift);
  }
}

void VertexAdaptation::finish() {
  std::copy_n(filter_.weight.begin(), filter_.size,
              &weights_.weights_[weights_.first_[vertex_]]);
}

}  // namespace rlpc
