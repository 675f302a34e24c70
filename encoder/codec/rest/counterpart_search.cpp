#include "encoder/codec/rest/counterpart_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/codec/mesh_prediction/rest_recon.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

// tuned: Largest error, in steps, of a prediction from a new counterpart, and of each length in
// its shape. Farther shapes match by chance.
constexpr double kTolerance = 3.0;
// tuned: Entries kept of a cell: enough to hold each copy of a part a few times, while the work
// at each vertex stays bounded on grids, where all shapes are alike.
constexpr std::size_t kCellEntries = 8;
// tuned: Vertices followed from a new counterpart. By then it has paid for itself many times.
constexpr std::size_t kFollowed = 32;
// fixed: Bad predictions after which it is not followed any further, which bounds the work at
// vertices of many triangles.
constexpr int kMaxBad = 6;
// tuned: Predictions of the search for each vertex, on average, where all vertices have
// counterparts. Smooth grids, where all shapes are alike, would take hundreds.
constexpr double kPredictions = 64.0;
// tuned (off: 64): The same where no vertices have counterparts.
constexpr double kFewestPredictions = 4.0;
// tuned: Vertices over which the part that has counterparts is averaged.
constexpr double kAveraged = 1000.0;

ListOfLists<std::uint32_t> find_dependents(const RestOrder& order) {
  std::vector<std::uint32_t> first(std::size_t{order.num_vertices()} + 1, 0);
  const auto for_each = [&](auto visit) {
    for (const std::uint32_t v : order.order()) {
      for (const Hinge& hinge : order.hinges(v)) {
        for (const std::uint32_t u : {hinge.a, hinge.b, hinge.c}) visit(u, v);
      }
    }
  };
  for_each([&](std::uint32_t u, std::uint32_t) { ++first[u + 1]; });
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  std::vector<std::uint32_t> items(first.back());
  for_each([&](std::uint32_t u, std::uint32_t v) { items[next[u]++] = v; });
  return {std::move(first), std::move(items)};
}

}  // namespace

CounterpartSearch::CounterpartSearch(const RestOrder& order,
                                     std::span<const std::int32_t> wanted,
                                     std::uint32_t rest_step, int position_bits)
    : order_(order),
      wanted_(wanted),
      step_(rest_step),
      prediction_(order, wanted, rest_bits(position_bits)),
      dependents_(find_dependents(order)),
      assumed_(order.num_vertices(), Counterparts::kNone),
      seen_(order.num_vertices(), 0) {}

double CounterpartSearch::distance(std::uint32_t u, std::uint32_t v) const {
  double sum = 0.0;
  for (std::size_t c = 0; c < kRestFactors; ++c) {
    const double d = static_cast<double>(wanted_[u * kRestFactors + c]) -
                     static_cast<double>(wanted_[v * kRestFactors + c]);
    sum += d * d;
  }
  return std::sqrt(sum) / step_;
}

CounterpartSearch::Cell CounterpartSearch::cell_of(std::uint32_t v, const Hinge& hinge) const {
  return {round_to_int(distance(hinge.a, hinge.b) / kTolerance),
          round_to_int(distance(v, hinge.c) / kTolerance)};
}

std::uint64_t CounterpartSearch::key_of(const Cell& cell) {
  return static_cast<std::uint64_t>(cell.edge) << 32 ^
         static_cast<std::uint64_t>(cell.diagonal);
}

bool CounterpartSearch::has_shape_of(std::uint32_t v, const Hinge& own, const Entry& entry,
                                     bool mirrored) const {
  Hinge other = order_.hinges(entry.vertex)[entry.hinge];
  if (mirrored) std::swap(other.a, other.b);
  const auto near = [&](std::uint32_t a, std::uint32_t b, std::uint32_t p, std::uint32_t q) {
    return std::fabs(distance(a, b) - distance(p, q)) <= kTolerance;
  };
  return near(own.a, own.b, other.a, other.b) && near(v, own.c, entry.vertex, other.c) &&
         near(v, own.a, entry.vertex, other.a) && near(v, own.b, entry.vertex, other.b) &&
         near(own.c, own.a, other.c, other.a) && near(own.c, own.b, other.c, other.b);
}

// Returns the error in steps.
double CounterpartSearch::error_of(std::uint32_t v, const HingePairs& pairs) {
  --allowance_;
  RestAxes axes;
  const Vec3l predicted = predict_from_counterpart(prediction_, pairs, axes);
  double sum = 0.0;
  for (std::size_t c = 0; c < kRestFactors; ++c) {
    const auto d = static_cast<double>(predicted[c] - wanted_[v * kRestFactors + c]);
    sum += d * d;
  }
  return std::sqrt(sum) / step_;
}

// Returns the bits that vertices after v save if they inherit from it.
double CounterpartSearch::growth(std::uint32_t v, const HingePairs& pairs,
                                 const Counterparts& counterparts) {
  std::vector<std::uint32_t> changed;
  const auto assume = [&](std::uint32_t u, std::uint32_t counterpart) {
    assumed_[u] = counterpart;
    changed.push_back(u);
  };
  const auto passed_on = [&](std::uint32_t u) {
    return assumed_[u] != Counterparts::kNone ? assumed_[u] : counterparts.passed_on(u);
  };
  const HingePair& first = pairs.list[0];
  assume(first.own.a, first.mirrored ? first.other.b : first.other.a);
  assume(first.own.b, first.mirrored ? first.other.a : first.other.b);
  assume(first.own.c, first.other.c);
  assume(v, pairs.counterpart);
  std::vector<std::uint32_t> followed{v};
  std::vector<std::uint32_t> visited;
  double gain = 0.0;
  int bad = 0;
  for (std::size_t i = 0; i < followed.size() && bad < kMaxBad; ++i) {
    for (const std::uint32_t u : dependents_[followed[i]]) {
      if (followed.size() >= kFollowed || order_.place(u) <= order_.place(v) || seen_[u] != 0) {
        continue;
      }
      const HingePairs inherited = inherited_pairs(order_, u, passed_on);
      if (inherited.size == 0) continue;
      seen_[u] = 1;
      visited.push_back(u);
      const double error = error_of(u, inherited);
      if (error > kTolerance) {
        ++bad;
        continue;
      }
      const Vec3l base = prediction_.base(order_.hinges(u));
      double square = 0.0;
      for (std::size_t c = 0; c < kRestFactors; ++c) {
        const auto d = static_cast<double>(base[c] - wanted_[u * kRestFactors + c]);
        square += d * d;
      }
      const double without = std::max(std::sqrt(square) / step_, 1.0);
      gain += kRestFactors * det_log2(without / std::max(error, 1.0));
      assume(u, inherited.counterpart);
      followed.push_back(u);
    }
  }
  for (const std::uint32_t u : changed) assumed_[u] = Counterparts::kNone;
  for (const std::uint32_t u : visited) seen_[u] = 0;
  return gain;
}

std::optional<CounterpartSearch::Found> CounterpartSearch::find(
    std::uint32_t v, const Counterparts& counterparts) {
  std::optional<Found> best;
  allowance_ +=
      round_to_int(kFewestPredictions + used_part_ * (kPredictions - kFewestPredictions));
  if (allowance_ <= 0) return best;
  const auto hinges = order_.hinges(v);
  const auto try_entry = [&](std::size_t k, const Entry& entry, bool mirrored) {
    if (!has_shape_of(v, hinges[k], entry, mirrored)) return;
    HingePairs pairs;
    pairs.list[0] = {hinges[k], order_.hinges(entry.vertex)[entry.hinge], mirrored};
    pairs.size = 1;
    pairs.counterpart = entry.vertex;
    if (error_of(v, pairs) > kTolerance) return;
    const double gain = growth(v, pairs, counterparts);
    if (best && best->gain >= gain) return;
    Counterpart choice;
    choice.new_flag = true;
    choice.mirrored = mirrored;
    choice.hinge = static_cast<std::uint8_t>(k);
    choice.idx = entry.idx;
    best = Found{choice, gain};
  };
  for (std::size_t k = 0; k < hinges.size(); ++k) {
    const Cell at = cell_of(v, hinges[k]);
    for (std::int64_t i = -1; i <= 1; ++i) {
      for (std::int64_t j = -1; j <= 1; ++j) {
        const auto found = cells_.find(key_of({at.edge + i, at.diagonal + j}));
        if (found == cells_.end()) continue;
        for (const Entry& entry : found->second) {
          try_entry(k, entry, false);
          try_entry(k, entry, true);
        }
      }
    }
  }
  return best;
}

void CounterpartSearch::add(std::uint32_t v, bool used) {
  used_part_ += ((used ? 1.0 : 0.0) - used_part_) / kAveraged;
  const auto hinges = order_.hinges(v);
  for (std::size_t k = 0; k < hinges.size(); ++k) {
    std::vector<Entry>& entries = cells_[key_of(cell_of(v, hinges[k]))];
    if (entries.size() == kCellEntries) entries.erase(entries.begin());
    entries.push_back({v, static_cast<std::uint8_t>(k), num_listed_++});
  }
}

}  // namespace rlpc
