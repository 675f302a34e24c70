// Looks for the residuals of a track with the lowest Lagrangian cost: a search with survivors
// over the places of the track, one coordinate at a time, in closed loop.
//
// A residual decides what later values are predicted from, so the better of the two integers
// next to a wanted residual shows only some places later. Survivors are the best sequences of
// choices so far. Two that agree in the last values go on alike, so only the cheaper one is
// kept, and few survivors suffice.
//
// Rates are those of the real contexts of each survivor. The models adapt along the best one,
// as copies for each would take most of the time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "common/codec/components/track_models.h"
#include "common/codec/components/track_order.h"
#include "common/codec/mesh/mesh.h"
#include "encoder/codec/kinds/skinned/tracks/track_state.h"
#include "encoder/codec/write/bit_cost.h"
#include "encoder/codec/write/write_residual.h"

namespace rlpc {

struct SearchBreadth {
  std::size_t survivors = 4;
  // Survivors are alike if this many latest values agree.
  std::size_t memory = 3;
};

// Bits of residuals under models that do not adapt meanwhile; bits that are asked for again are
// looked up.
class ResidualBits {
 public:
  void start(ResidualModels& models) {
    models_ = &models;
    bits_.fill(kUnknown);
  }
  double of(std::uint32_t expected, std::int32_t residual) {
    const ResidualContext context = residual_context(expected);
    if (context.index != index_ || context.shift != shift_) {
      index_ = context.index;
      shift_ = context.shift;
      bits_.fill(kUnknown);
    }
    const std::uint32_t magnitude = magnitude_of(residual);
    if (magnitude < bits_.size() && bits_[magnitude] != kUnknown) return bits_[magnitude];
    BitEstimate estimate;
    write_residual(estimate, *models_, expected, residual);
    if (magnitude < bits_.size()) bits_[magnitude] = estimate.bits();
    return estimate.bits();
  }

 private:
  static constexpr double kUnknown = -1.0;  // fixed: no number of bits
  ResidualModels* models_ = nullptr;
  int index_ = -1;
  int shift_ = -1;
  std::array<double, 8> bits_{};  // [magnitude]
};

// Orders the places of a track so that each comes as soon as those that predict it are known:
// choices at lower levels then soon show what they cost at higher ones. Keeps the order within
// each level.
std::vector<TrackPlace> search_order(std::span<const TrackPlace> order);

// Series: the values of a track in closed loop.
//   Value                          result at a place
//   Predicted                      its state before its residual is known; `wanted`: the
//                                  residual in steps, fractional, of each coordinate searched
//   predict(known, at, c)          known(f) returns the Value at an earlier place
//   follow(predicted, residual, c) changes other coordinates of the residual if they must
//                                  change with the prediction; returns their squared error
//   value(predicted, residual, at, c)
//   are_alike(a, b)                whether later predictions are nearly equal
template <class Series>
class ResidualSearch {
 public:
  using Value = typename Series::Value;

  // order: from search_order(). The references must outlive the search.
  ResidualSearch(const Series& series, std::span<const TrackPlace> order,
                 const TrackState& before, const SearchBreadth& breadth)
      : series_(series), order_(order), before_(before), breadth_(breadth) {
    std::uint32_t widest = 1;
    for (const TrackPlace& at : order) widest = std::max(widest, at.stride);
    // Predictions reach back by four strides, and wait for at most three strides of level 0.
    window_ = std::size_t{8} * widest;
  }

  // Replaces coordinate c of the residuals [num_frames].
  void improve(std::size_t c, std::vector<Vec3i>& residuals);

 private:
  struct Survivor {
    double cost = 0.0;
    std::vector<RunningMagnitude> magnitude;  // [level], coordinate c
    std::vector<Value> values;                // [window_], by frame
    // State at the next place:
    typename Series::Predicted predicted;
    std::uint32_t expected = 0;
    Vec3i residual{};  // valid except for coordinate c
  };
  struct Choice {
    double cost;
    std::int32_t residual;  // coordinate c
    std::uint32_t survivor;
  };

  auto known(const Survivor& survivor) const {
    return [&survivor, this](std::uint32_t f) -> const Value& {
      return survivor.values[f & (window_ - 1)];
    };
  }
  void extend(const TrackPlace& at, std::size_t c, const Vec3i& base, std::uint32_t mean);
  void add_choice(const Choice& choice);
  void keep_best(std::size_t i, std::size_t c);
  bool is_new(std::size_t i, const Survivor& from, const Value& value) const;

  const Series& series_;
  std::span<const TrackPlace> order_;
  const TrackState& before_;
  SearchBreadth breadth_;
  std::size_t window_;
  TrackModels models_;
  ResidualBits bits_;
  std::vector<Choice> choices_;  // choices of all survivors, cheapest first
  std::size_t num_choices_ = 0;
  std::vector<Survivor> survivors_;
  std::vector<Survivor> next_;
  std::size_t num_survivors_ = 0;
  std::size_t num_next_ = 0;
  std::vector<std::pair<std::uint32_t, Vec3i>> history_;  // [place][survivor]: from, residual
};

template <class Series>
void ResidualSearch<Series>::improve(std::size_t c, std::vector<Vec3i>& residuals) {
  models_ = before_.models;
  const auto levels = static_cast<std::size_t>(order_.back().level) + 1;
  survivors_.assign(breadth_.survivors, {.magnitude = std::vector<RunningMagnitude>(levels),
                                         .values = std::vector<Value>(window_),
                                         .predicted = {}});
  next_ = survivors_;
  choices_.resize(2 * breadth_.survivors);
  history_.resize(order_.size() * breadth_.survivors);
  num_survivors_ = 1;
  TrackMagnitudes others;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const TrackPlace& at = order_[i];
    const Vec3i& base = residuals[at.frame];
    ResidualModels& models = models_[models_of_level(at.level)];
    std::uint32_t mean = before_.mean[at.frame];
    BitCost unused;  // writing adapts the models
    const auto pass = [&](std::size_t other) {
      RunningMagnitude& magnitude = others[static_cast<std::size_t>(at.level)][other];
      write_residual(unused, models, expected_in_track(magnitude, mean), base[other]);
      magnitude.update(magnitude_of(base[other]));
      mean = update_mean(mean, magnitude_of(base[other]), 3);
    };
    for (std::size_t other = 0; other < c; ++other) pass(other);
    extend(at, c, base, mean);
    const Choice& best = choices_.front();
    write_residual(unused, models, survivors_[best.survivor].expected, best.residual);
    mean = update_mean(mean, magnitude_of(best.residual), 3);
    for (std::size_t other = c + 1; other < 3; ++other) pass(other);
    keep_best(i, c);
  }
  std::size_t survivor = 0;
  for (std::size_t i = order_.size(); i-- > 0;) {
    const auto& [from, residual] = history_[i * breadth_.survivors + survivor];
    residuals[order_[i].frame] = residual;
    survivor = from;
  }
}

// Lists the two integers next to the residual that each survivor wants, cheapest choice first.
template <class Series>
void ResidualSearch<Series>::extend(const TrackPlace& at, std::size_t c, const Vec3i& base,
                                    std::uint32_t mean) {
  constexpr double kMax = static_cast<double>(kMaxResidual) - 1.0;  // fixed: format
  bits_.start(models_[models_of_level(at.level)]);
  num_choices_ = 0;
  for (std::size_t k = 0; k < num_survivors_; ++k) {
    Survivor& survivor = survivors_[k];
    survivor.predicted = series_.predict(known(survivor), at, c);
    survivor.expected =
        expected_in_track(survivor.magnitude[static_cast<std::size_t>(at.level)], mean);
    survivor.residual = base;
    const double cost =
        survivor.cost + series_.follow(survivor.predicted, survivor.residual, c);
    const double wanted = survivor.predicted.wanted[c];
    const auto below = static_cast<std::int32_t>(std::floor(std::clamp(wanted, -kMax, kMax)));
    for (const std::int32_t x : {below, below + 1}) {
      const double error = wanted - x;
      add_choice({cost + error * error + kLambda * bits_.of(survivor.expected, x), x,
                  static_cast<std::uint32_t>(k)});
    }
  }
}

template <class Series>
void ResidualSearch<Series>::add_choice(const Choice& choice) {
  std::size_t place = num_choices_++;
  for (; place > 0 && choice.cost < choices_[place - 1].cost; --place) {
    choices_[place] = choices_[place - 1];
  }
  choices_[place] = choice;
}

template <class Series>
void ResidualSearch<Series>::keep_best(std::size_t i, std::size_t c) {
  const TrackPlace& at = order_[i];
  num_next_ = 0;
  for (std::size_t n = 0; n < num_choices_ && num_next_ < breadth_.survivors; ++n) {
    const Choice& choice = choices_[n];
    const Survivor& from = survivors_[choice.survivor];
    Vec3i residual = from.residual;
    residual[c] = choice.residual;
    const Value value = series_.value(from.predicted, residual, at, c);
    if (!is_new(i, from, value)) continue;
    Survivor& kept = next_[num_next_];
    kept.cost = choice.cost;
    std::copy(from.magnitude.begin(), from.magnitude.end(), kept.magnitude.begin());
    kept.magnitude[static_cast<std::size_t>(at.level)].update(magnitude_of(choice.residual));
    std::copy(from.values.begin(), from.values.end(), kept.values.begin());
    kept.values[at.frame & (window_ - 1)] = value;
    history_[i * breadth_.survivors + num_next_] = {choice.survivor, residual};
    ++num_next_;
  }
  survivors_.swap(next_);
  num_survivors_ = num_next_;
}

// Whether none of the survivors kept at place i agrees in the last values.
template <class Series>
bool ResidualSearch<Series>::is_new(std::size_t i, const Survivor& from,
                                    const Value& value) const {
  const std::size_t count = std::min(breadth_.memory, i + 1);
  for (std::size_t k = 0; k < num_next_; ++k) {
    const auto kept_values = known(next_[k]);
    bool alike = series_.are_alike(kept_values(order_[i].frame), value);
    for (std::size_t back = 1; back < count && alike; ++back) {
      const std::uint32_t f = order_[i - back].frame;
      alike = series_.are_alike(kept_values(f), known(from)(f));
    }
    if (alike) return false;
  }
  return true;
}

}  // namespace rlpc
