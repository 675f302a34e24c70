#include "common/pca.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace rlpc {
namespace {

constexpr int kNarrowBits = 16;
constexpr std::int64_t kMaxNarrowSum = (std::int64_t{1} << 31) - 1;

// sums[i] += w * s[i], in blocks that a compiler turns into 16 x 16 -> 32-bit products.
void add_product(std::int16_t w, const std::int16_t* s, std::int32_t* sums, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) sums[i] += std::int32_t{w} * s[i];
}

// Two components in one pass over the sums.
void add_two_products(std::int16_t w0, const std::int16_t* s0, std::int16_t w1,
                      const std::int16_t* s1, std::int32_t* sums, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    sums[i] += std::int32_t{w0} * s0[i] + std::int32_t{w1} * s1[i];
  }
}

}  // namespace

void FactorSet::add(std::span<const std::int32_t> temporal, int temporal_bits,
                    std::span<const std::int32_t> spatial, int spatial_bits) {
  assert(temporal.size() == num_frames_ && spatial.size() == num_values_);
  const int factor_bits = spatial_factor_bits(spatial_bits);
  const int shift = factor_bits - spatial_bits;
  if (factor_bits > kNarrowBits || temporal_bits > kNarrowBits) {
    Wide wide;
    wide.temporal.assign(temporal.begin(), temporal.end());
    wide.spatial.reserve(num_values_);
    for (const std::int32_t s : spatial) wide.spatial.push_back(s * (1 << shift));
    wide_.push_back(std::move(wide));
    return;
  }
  const std::int64_t bound = std::int64_t{1} << (factor_bits + temporal_bits - 2);
  if (narrow_.empty() || narrow_.back().bound + bound > kMaxNarrowSum) narrow_.emplace_back();
  NarrowGroup& group = narrow_.back();
  group.bound += bound;
  ++group.size;
  for (const std::int32_t t : temporal) group.temporal.push_back(static_cast<std::int16_t>(t));
  for (const std::int32_t s : spatial) {
    group.spatial.push_back(static_cast<std::int16_t>(s * (1 << shift)));
  }
}

void FactorSet::sum_narrow(const NarrowGroup& group, std::size_t frame,
                           std::span<std::int32_t> sums) const {
  std::fill(sums.begin(), sums.end(), 0);
  const auto w = [&](std::size_t k) { return group.temporal[k * num_frames_ + frame]; };
  const auto s = [&](std::size_t k) { return group.spatial.data() + k * num_values_; };
  std::size_t k = 0;
  for (; k + 1 < group.size; k += 2) {
    add_two_products(w(k), s(k), w(k + 1), s(k + 1), sums.data(), sums.size());
  }
  if (k < group.size) add_product(w(k), s(k), sums.data(), sums.size());
}

void FactorSet::sum(std::size_t frame, std::span<std::int64_t> sums) const {
  assert(sums.size() == num_values_ && frame < num_frames_);
  std::fill(sums.begin(), sums.end(), 0);
  std::vector<std::int32_t> narrow_sums(num_values_);
  for (const NarrowGroup& group : narrow_) {
    sum_narrow(group, frame, narrow_sums);
    for (std::size_t i = 0; i < num_values_; ++i) sums[i] += narrow_sums[i];
  }
  for (const Wide& wide : wide_) {
    const std::int64_t w = wide.temporal[frame];
    for (std::size_t i = 0; i < num_values_; ++i) sums[i] += w * wide.spatial[i];
  }
}

}  // namespace rlpc
