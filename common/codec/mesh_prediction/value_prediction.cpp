#include "common/codec/mesh_prediction/value_prediction.h"

#include <algorithm>
#include <utility>

#include "common/codec/bits/int_math.h"

namespace rlpc {
namespace {

// 8.10.3: returns the parallelogram with the latest edge.
const Parallelogram& latest_of(std::span<const Parallelogram> list) {
  return *std::max_element(list.begin(), list.end(),
                           [](const Parallelogram& p, const Parallelogram& q) {
                             return std::pair(p.b, p.a) < std::pair(q.b, q.a);
                           });
}

}  // namespace

void ValuePrediction::by_parallelograms(std::span<const Parallelogram> list,
                                        std::span<const std::int32_t> values,
                                        std::span<std::int64_t> prediction) const {
  const std::size_t n = prediction.size();
  const bool one = mesh_.prediction() == Prediction::kParallelogram;
  const auto used = one ? std::span(&latest_of(list), 1) : list;
  for (const Parallelogram& p : used) {
    for (std::size_t k = 0; k < n; ++k) {
      prediction[k] +=
          std::int64_t{values[p.a * n + k]} + values[p.b * n + k] - values[p.c * n + k];
    }
  }
  const auto count = static_cast<std::int64_t>(used.size());
  if (count == 1) return;
  for (std::int64_t& x : prediction) x = div_round(x, count);
}

void ValuePrediction::predict(std::uint32_t v, std::span<const std::int32_t> values,
                              std::span<std::int64_t> prediction) const {
  const std::size_t n = prediction.size();
  std::fill(prediction.begin(), prediction.end(), 0);
  const auto ring = mesh_.ring(v);
  if (weights_ != nullptr) {
    const auto outer_ring = mesh_.outer_ring(v);
    const auto weights = (*weights_)[v];
    const auto add = [&](std::uint32_t u, std::int32_t w) {
      loops_.add_weighted(&values[std::size_t{u} * n], w, n, prediction.data());
    };
    for (std::size_t i = 0; i < ring.size(); ++i) add(ring[i], weights[i]);
    for (std::size_t i = 0; i < outer_ring.size(); ++i) {
      add(outer_ring[i], weights[ring.size() + i]);
    }
    for (std::int64_t& x : prediction) x = round2(x, kWeightFractionBits);
    return;
  }
  if (mesh_.prediction() == Prediction::kNone && !is_rest_) return;
  if (mesh_.prediction() != Prediction::kLayers && !mesh_.parallelograms(v).empty()) {
    by_parallelograms(mesh_.parallelograms(v), values, prediction);
    return;
  }
  if (ring.empty()) return;
  for (const std::uint32_t u : ring) {
    for (std::size_t k = 0; k < n; ++k) prediction[k] += values[std::size_t{u} * n + k];
  }
  const auto count = static_cast<std::int64_t>(ring.size());
  for (std::int64_t& x : prediction) x = div_round(x, count);
}

}  // namespace rlpc
