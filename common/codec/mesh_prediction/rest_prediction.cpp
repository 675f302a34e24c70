#include "common/codec/mesh_prediction/rest_prediction.h"

#include <algorithm>

namespace rlpc {
namespace {

Vec3l cross(const Vec3l& x, const Vec3l& y) {
  return {x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
}

}  // namespace

Vec3l RestPrediction::predict(std::uint32_t v, const Weights& weights) const {
  const auto ring = order_.ring(v);
  const auto hinges = order_.hinges(v);
  Vec3l prediction{};
  if (ring.empty()) return prediction;
  const auto n = static_cast<std::int64_t>(ring.size());
  const auto m = static_cast<std::int64_t>(hinges.size());
  for (std::size_t c = 0; c < 3; ++c) {
    std::int64_t ring_sum = 0;
    for (const std::uint32_t u : ring) ring_sum += at(u, c);
    if (hinges.empty()) {
      prediction[c] = div_round(ring_sum, n);
      continue;
    }
    std::int64_t ends = 0;
    std::int64_t height = 0;
    for (const Hinge& hinge : hinges) {
      ends += at(hinge.a, c) + at(hinge.b, c);
      height += at(hinge.a, c) + at(hinge.b, c) - 2 * at(hinge.c, c);
    }
    const std::int64_t sum = n * ((16 - weights.ring) * ends + weights.edge * height) +
                             2 * m * weights.ring * ring_sum;
    prediction[c] = clip_signed(bits_, div_round(sum, 32 * m * n));
  }
  return prediction;
}

RestAxes RestPrediction::axes(std::span<const Hinge> hinges) const {
  std::array<std::array<Vec3l, 2>, kMaxRestHinges> arms{};
  std::int64_t largest = 1;
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      arms[i][0][c] = at(hinges[i].a, c) - at(hinges[i].c, c);
      arms[i][1][c] = at(hinges[i].b, c) - at(hinges[i].c, c);
      for (const Vec3l& arm : arms[i])
        largest = std::max(largest, arm[c] < 0 ? -arm[c] : arm[c]);
    }
  }
  const int shift = std::max(floor_log2(static_cast<std::uint64_t>(largest)) - 20, 0);
  Vec3l area{};
  Vec3l height{};
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    for (Vec3l& arm : arms[i]) {
      for (std::size_t c = 0; c < 3; ++c) {
        arm[c] = round2(arm[c], shift);
        height[c] += arm[c];
      }
    }
    const Vec3l hinge_area = cross(arms[i][0], arms[i][1]);
    for (std::size_t c = 0; c < 3; ++c) area[c] += hinge_area[c];
  }
  const Vec3l normal = normalize3(area);
  const Vec3l side = normalize3(cross(normal, height));
  if (side == Vec3l{}) return world();
  Vec3l along = cross(side, normal);
  for (std::int64_t& x : along) x = round2(x, 30);
  return {normal, along, side};
}

Vec3l RestPrediction::base(std::span<const Hinge> hinges) const {
  Vec3l sum{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (const Hinge& hinge : hinges)
      sum[c] += at(hinge.a, c) + at(hinge.b, c) - at(hinge.c, c);
    sum[c] = div_round(sum[c], static_cast<std::int64_t>(hinges.size()));
  }
  return sum;
}

Vec3l RestPrediction::from_counterpart(std::span<const Hinge> own, const RestAxes& own_axes,
                                       std::span<const Hinge> other, std::uint32_t counterpart,
                                       bool mirrored) const {
  constexpr std::int64_t kMax = std::int64_t{1} << 28;
  const RestAxes other_axes = axes(other);
  Vec3l offset = base(other);
  for (std::size_t c = 0; c < 3; ++c) {
    offset[c] = clip3(-kMax, kMax, at(counterpart, c) - offset[c]);
  }
  Vec3l along{};
  for (std::size_t i = 0; i < 3; ++i) {
    along[i] = round2(other_axes[i][0] * offset[0] + other_axes[i][1] * offset[1] +
                          other_axes[i][2] * offset[2],
                      30);
  }
  if (mirrored) along[2] = -along[2];
  Vec3l prediction = turned(own_axes, along);
  const Vec3l from = base(own);
  for (std::size_t c = 0; c < 3; ++c) {
    prediction[c] = clip_signed(bits_, from[c] + prediction[c]);
  }
  return prediction;
}

}  // namespace rlpc
