#include "encoder/codec/kinds/skinned/fit/bone_weights.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "encoder/codec/math/small_system.h"

namespace rlpc {
namespace {

constexpr std::size_t kMax = kMaxExtraBones;

struct Blend {
  std::size_t size = 0;
  std::array<std::size_t, kMax> chosen{};
  std::array<double, kMax> weight{};
  double error = 0.0;

  bool has(std::size_t i) const {
    return std::find(chosen.begin(), chosen.begin() + size, i) != chosen.begin() + size;
  }
  void drop(std::size_t place) {
    --size;
    for (std::size_t i = place; i < size; ++i) chosen[i] = chosen[i + 1];
  }
};

class SparseBlend {
 public:
  SparseBlend(std::span<const double> gram, std::size_t stride, std::size_t count)
      : gram_(gram), stride_(stride), count_(count) {
    double trace = 0.0;
    for (std::size_t i = 0; i < count; ++i) trace += at(i, i);
    constexpr double kRegular = 1e-9;  // fixed: candidates that move alike share the weight
    regular_ = kRegular * trace / static_cast<double>(count) + kSmallest;
  }

  Blend single() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < count_; ++i) {
      if (at(i, i) < at(best, best)) best = i;
    }
    return {1, {best}, {1.0}, at(best, best)};
  }

  // Computes solve() for two candidates, the usual case, bit-exactly in a fraction of the time.
  Blend pair(std::size_t first, std::size_t second) const {
    Blend blend{2, {first, second}, {}, 0.0};
    const double own = at(first, first) + regular_;
    const double both = at(first, second);
    const double factor = both / own;
    const double left = at(second, second) + regular_ - factor * both;
    const double x = (1.0 - factor) / left;
    const double y = (1.0 - both * x) / own;
    if (!(own > 0.0 && left > 0.0 && x + y > 0.0)) {
      solve(blend);
      return blend;
    }
    const double u = x / (x + y);
    const double w = y / (x + y);
    if (std::min(w, u) > 0.0) {
      blend.weight = {w, u};
      blend.error =
          w * w * at(first, first) + w * u * both + u * w * both + u * u * at(second, second);
    } else {
      const std::size_t kept = u < w ? first : second;
      blend = {1, {kept}, {1.0}, at(kept, kept)};
    }
    blend.error = std::max(blend.error, 0.0);
    return blend;
  }

  // Finds optimal weights of the chosen candidates, after removing those with negative weights.
  void solve(Blend& blend) const {
    for (;;) {
      unconstrained(blend);
      const auto end = blend.weight.begin() + blend.size;
      const auto min = std::min_element(blend.weight.begin(), end);
      if (*min > 0.0 || blend.size == 1) break;
      blend.drop(static_cast<std::size_t>(min - blend.weight.begin()));
    }
    double error = 0.0;
    for (std::size_t i = 0; i < blend.size; ++i) {
      for (std::size_t j = 0; j < blend.size; ++j) {
        error += blend.weight[i] * blend.weight[j] * at(blend.chosen[i], blend.chosen[j]);
      }
    }
    blend.error = std::max(error, 0.0);
  }

 private:
  static constexpr double kSmallest = 1e-200;  // fixed: above zero

  double at(std::size_t i, std::size_t j) const { return gram_[i * stride_ + j]; }

  // Minimises w^T gram w subject to sum 1: w is proportional to gram^-1 times a vector of ones.
  void unconstrained(Blend& blend) const {
    const std::size_t n = blend.size;
    SmallSystem<kMax> m;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) m.a[i][j] = at(blend.chosen[i], blend.chosen[j]);
      m.a[i][i] += regular_;
      m.b[i] = 1.0;
    }
    const auto x = solve_small(m, n).x;
    double sum = 0.0;
    for (std::size_t k = n; k-- > 0;) sum += x[k];
    for (std::size_t k = 0; k < n; ++k) {
      blend.weight[k] = sum > 0.0 ? x[k] / sum : 1.0 / static_cast<double>(n);
    }
  }

  std::span<const double> gram_;
  std::size_t stride_;
  std::size_t count_;
  double regular_ = 0.0;
};

}  // namespace

BoneWeights sparse_weights(std::span<const double> gram, std::size_t stride, std::size_t count,
                           std::size_t max_influences, double error_per_influence) {
  assert(count > 0 && max_influences > 0 && max_influences <= kMax);
  const SparseBlend problem(gram, stride, count);
  Blend current = problem.single();
  while (current.size < max_influences) {
    Blend best;
    for (std::size_t j = 0; j < count; ++j) {
      if (current.has(j)) continue;
      Blend blend = current;
      if (current.size == 1) {
        blend = problem.pair(current.chosen[0], j);
      } else {
        blend.chosen[blend.size++] = j;
        problem.solve(blend);
      }
      if (blend.has(j) && (best.size == 0 || blend.error < best.error)) best = blend;
    }
    constexpr double kWorthwhile = 1.0 - 1e-9;  // fixed: rounding
    if (best.size == 0) break;
    const double more = (static_cast<double>(best.size) - static_cast<double>(current.size)) *
                        error_per_influence;
    if (best.error + more >= current.error * kWorthwhile) break;
    current = best;
  }
  BoneWeights result;
  result.error = current.error;
  for (std::size_t i = 0; i < current.size; ++i) {
    result.weights.push_back(
        {static_cast<std::uint32_t>(current.chosen[i]), current.weight[i]});
  }
  std::sort(result.weights.begin(), result.weights.end(),
            [](const RigWeight& a, const RigWeight& b) {
              return a.weight != b.weight ? a.weight > b.weight : a.bone < b.bone;
            });
  return result;
}

}  // namespace rlpc
