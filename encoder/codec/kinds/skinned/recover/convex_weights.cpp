#include "encoder/codec/kinds/skinned/recover/convex_weights.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

class Simplex {
 public:
  Simplex(std::span<const double> gram, std::size_t count) : gram_(gram), count_(count) {
    for (std::size_t i = 0; i < count; ++i) trace_ += at(i, i);
  }

  // Solves over some of the errors by the method of active sets (Lawson and Hanson 1974).
  std::vector<double> solve(const std::vector<std::size_t>& of) const {
    constexpr double kGain = 1e-12;  // fixed: rounding
    std::vector<double> w(count_, 0.0);
    std::size_t first = of.front();
    for (const std::size_t i : of) {
      if (at(i, i) < at(first, first)) first = i;
    }
    std::vector<std::size_t> active{first};
    w[first] = 1.0;
    for (std::size_t rounds = 3 * of.size(); rounds > 0; --rounds) {
      std::vector<double> slope(count_, 0.0);
      double now = 0.0;
      for (const std::size_t i : of) {
        for (const std::size_t j : active) slope[i] += at(i, j) * w[j];
        now += w[i] * slope[i];
      }
      std::size_t next = count_;
      for (const std::size_t i : of) {
        if (std::find(active.begin(), active.end(), i) != active.end()) continue;
        if (next == count_ || slope[i] < slope[next]) next = i;
      }
      if (next == count_ || slope[next] >= now - kGain * trace_) break;
      active.push_back(next);
      if (!settle(active, w)) break;
    }
    return w;
  }

 private:
  double at(std::size_t i, std::size_t j) const { return gram_[i * count_ + j]; }

  // Moves the weights to the best ones of the active errors, and leaves out those that would
  // become negative.
  bool settle(std::vector<std::size_t>& active, std::vector<double>& w) const {
    constexpr double kRegular = 1e-10;    // fixed: errors that are alike share the weight
    constexpr double kSmallest = 1e-200;  // fixed: above zero
    constexpr double kZero = 1e-15;       // fixed: rounding
    while (!active.empty()) {
      const std::size_t n = active.size();
      std::vector<double> a(n * n);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) a[i * n + j] = at(active[i], active[j]);
        a[i * n + i] += kRegular * trace_ / static_cast<double>(count_) + kSmallest;
      }
      std::vector<double> x(n, 1.0);
      SymmetricSystem(std::move(a), n).solve(x);
      const double sum = std::accumulate(x.begin(), x.end(), 0.0);
      if (!(sum > 0.0)) return false;
      for (double& value : x) value /= sum;
      double part = 1.0;
      for (std::size_t i = 0; i < n; ++i) {
        if (x[i] < 0.0) part = std::min(part, w[active[i]] / (w[active[i]] - x[i]));
      }
      std::vector<std::size_t> kept;
      for (std::size_t i = 0; i < n; ++i) {
        double& value = w[active[i]];
        value += part * (x[i] - value);
        const bool leaves = part < 1.0 && x[i] < 0.0 && value <= kZero;
        if (leaves || value < 0.0) {
          value = 0.0;
        } else {
          kept.push_back(active[i]);
        }
      }
      if (kept.size() == active.size()) return part == 1.0;
      active = std::move(kept);
    }
    return false;
  }

  std::span<const double> gram_;
  std::size_t count_;
  double trace_ = 0.0;
};

}  // namespace

std::vector<double> convex_weights(std::span<const double> gram, std::size_t count,
                                   std::size_t max_count) {
  const Simplex simplex(gram, count);
  std::vector<std::size_t> of(count);
  std::iota(of.begin(), of.end(), std::size_t{0});
  std::vector<double> w = simplex.solve(of);
  std::stable_sort(of.begin(), of.end(),
                   [&](std::size_t a, std::size_t b) { return w[a] > w[b]; });
  if (count > max_count && w[of[max_count]] > 0.0) {
    of.resize(max_count);
    w = simplex.solve(of);
  }
  return w;
}

}  // namespace rlpc
