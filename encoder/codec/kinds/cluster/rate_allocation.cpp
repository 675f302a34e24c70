#include "encoder/codec/kinds/cluster/rate_allocation.h"

#include <limits>

namespace rlpc {
namespace {

struct HullStep {
  std::size_t to = 0;
  double slope = 0.0;  // distortion saved per unit of rate; 0: the hull ends here
};

// Returns the next point on the lower convex hull after `from`.
HullStep next_on_hull(const RdCurve& curve, std::size_t from) {
  HullStep best{from, 0.0};
  for (std::size_t l = from + 1; l < curve.size(); ++l) {
    const double rate = curve[l].rate - curve[from].rate;
    const double saved = curve[from].distortion - curve[l].distortion;
    if (rate <= 0.0) {
      if (saved > 0.0) return {l, std::numeric_limits<double>::infinity()};
      continue;
    }
    if (saved / rate > best.slope) best = {l, saved / rate};
  }
  return best;
}

}  // namespace

std::vector<std::size_t> allocate_within(const std::vector<RdCurve>& curves,
                                         double total_rate) {
  std::vector<std::size_t> chosen(curves.size(), 0);
  std::vector<HullStep> step(curves.size());
  double rate = 0.0;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    step[i] = next_on_hull(curves[i], 0);
    rate += curves[i][0].rate;
  }
  for (;;) {
    std::size_t steepest = 0;
    for (std::size_t i = 1; i < curves.size(); ++i) {
      if (step[i].slope > step[steepest].slope) steepest = i;
    }
    if (curves.empty() || step[steepest].slope <= 0.0) return chosen;
    const RdCurve& curve = curves[steepest];
    const double more = curve[step[steepest].to].rate - curve[chosen[steepest]].rate;
    if (rate + more > total_rate) {
      step[steepest].slope =
          0.0;  // exceeds the budget; a flatter step of another curve may fit
      continue;
    }
    rate += more;
    chosen[steepest] = step[steepest].to;
    step[steepest] = next_on_hull(curve, chosen[steepest]);
  }
}

std::size_t allocate_by_slope(const RdCurve& curve, double lambda) {
  std::size_t chosen = 0;
  for (;;) {
    const HullStep step = next_on_hull(curve, chosen);
    if (step.slope <= lambda) return chosen;
    chosen = step.to;
  }
}

}  // namespace rlpc
