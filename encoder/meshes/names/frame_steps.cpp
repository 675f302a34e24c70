#include "encoder/meshes/names/frame_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace rlpc {

namespace {

// Returns the position of the first digit that is not 0; for 0, before all others.
int exponent_of(double value) {
  if (value == 0.0) return std::numeric_limits<int>::min();
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

// Returns half a unit of the last known decimal of each value, in the order of the values.
// Zeros at the end may be left out, and six significant digits leave fewer decimals to greater
// values: a value is known to the decimals of any that are as great or greater.
std::vector<double> rounding_of(const Reading& reading, const std::vector<double>& values) {
  std::map<int, std::size_t> decimals;  // [position of the first digit]
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::size_t& max = decimals[exponent_of(values[i])];
    max = std::max(max, reading.numbers[reading.order[i]].fraction.size());
  }
  std::size_t max = 0;
  for (auto it = decimals.rbegin(); it != decimals.rend(); ++it) {
    max = it->second = std::max(max, it->second);
  }
  std::vector<double> rounding;
  rounding.reserve(values.size());
  for (const double value : values) {
    rounding.push_back(
        reading.has_fractions
            ? 0.5 * std::pow(10.0, -static_cast<double>(decimals[exponent_of(value)]))
            : 0.0);
  }
  return rounding;
}

// Returns the error that computing with doubles may add.
double slack_of(const std::vector<double>& values, double step) {
  const double greatest = std::max(std::abs(values.front()), std::abs(values.back()));
  return 1e-9 * step + 4.0 * std::numeric_limits<double>::epsilon() * greatest;
}

// Returns the narrowest room between the bounds of values, given by their rounding, and a line
// of this step; negative: the line leaves them.
double room_for(double step, const std::vector<double>& values,
                const std::vector<double>& rounding) {
  // Less than half a unit, so that no line goes through the ends of all roundings.
  constexpr double kWithin = 0.99;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double start = values[i] - values.front() - step * static_cast<double>(i);
    low = std::max(low, start - kWithin * rounding[i]);
    high = std::min(high, start + kWithin * rounding[i]);
  }
  return high - low;
}

// Whether some line meets all values within their rounding. The room is a concave function of
// its step.
bool are_on_a_line(const std::vector<double>& values, const std::vector<double>& rounding) {
  const auto count = static_cast<double>(values.size() - 1);
  const double step = (values.back() - values.front()) / count;
  const double slack = 2.0 * slack_of(values, step);
  if (room_for(step, values, rounding) >= -slack) return true;
  const double reach = (rounding.front() + rounding.back()) / count;
  double low = step - reach;
  double high = step + reach;
  constexpr int kRounds = 40;
  for (int i = 0; i < kRounds && reach > 0.0; ++i) {
    const double a = low + (high - low) / 3.0;
    const double b = high - (high - low) / 3.0;
    const double room_a = room_for(a, values, rounding);
    const double room_b = room_for(b, values, rounding);
    if (room_a >= -slack || room_b >= -slack) return true;
    (room_a < room_b ? low : high) = room_a < room_b ? a : b;
  }
  return false;
}

// Returns the gaps: differences beyond the smallest one.
std::vector<std::size_t> gaps_of(const std::vector<double>& values, double step) {
  std::vector<std::size_t> gaps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] - values[i - 1] > 1.1 * step) gaps.push_back(i - 1);
  }
  return gaps;
}

// Whether all differences are multiples of the smallest one, within their rounding.
bool are_multiples(const std::vector<double>& values, const std::vector<double>& rounding,
                   double step) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double difference = values[i] - values[i - 1];
    const double count = std::round(difference / step);
    const double unit = 2.0 * std::max(rounding[i - 1], rounding[i]);
    const double error = std::abs(difference - count * step);
    if (!(error <= (count + 1.0) * unit + count * slack_of(values, step))) return false;
  }
  return true;
}

// Whether the missing multiples of the smallest step are at most half of those present.
bool are_dense(const std::vector<double>& values, double step) {
  const double places = (values.back() - values.front()) / step + 1.0;
  const auto count = static_cast<double>(values.size());
  return 2.0 * (places - count) <= count + 1e-6;
}

// Whether gaps are missing frames: these leave few differences greater than a step of one unit
// of the last decimal; rounding leaves many.
bool are_gaps_real(const std::vector<std::size_t>& gaps, const std::vector<double>& values,
                   const std::vector<double>& rounding, double step) {
  const double unit = 2.0 * *std::min_element(rounding.begin(), rounding.end());
  return step < 1.5 * unit && 8 * gaps.size() < values.size();
}

}  // namespace

FrameSteps steps_of(const Reading& reading) {
  FrameSteps steps;
  for (const std::size_t name : reading.order) {
    steps.values.push_back(reading.numbers[name].value());
  }
  const std::vector<double>& values = steps.values;
  if (values.size() < 2) return steps;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < values.size(); ++i) {
    smallest = std::min(smallest, values[i] - values[i - 1]);
  }
  steps.step = smallest;
  steps.gaps = gaps_of(values, smallest);
  const auto rounding = rounding_of(reading, values);
  if (are_on_a_line(values, rounding) &&
      (steps.gaps.empty() || !are_gaps_real(steps.gaps, values, rounding, smallest))) {
    steps.step = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
    steps.is_rounded = !steps.gaps.empty();
    steps.gaps.clear();
  }
  for (std::size_t i = 1; i < values.size(); ++i) {
    steps.crosses_whole_frame |= std::floor(values[i]) != std::floor(values[i - 1]) &&
                                 values[i] - values[i - 1] <= 1.1 * steps.step;
  }
  if (!steps.gaps.empty()) {
    const bool are_few =
        2 * steps.gaps.size() < values.size() - 1 || are_dense(values, smallest);
    steps.regularity = are_few && are_multiples(values, rounding, smallest)
                           ? Regularity::kFewGaps
                           : Regularity::kIrregular;
  }
  return steps;
}

}  // namespace rlpc
