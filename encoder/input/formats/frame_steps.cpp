#include "encoder/input/formats/frame_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace rlpc {

namespace {

// The position of the first digit that is not 0; of 0, before all others.
int exponent_of(double value) {
  if (value == 0.0) return std::numeric_limits<int>::min();
  return static_cast<int>(std::floor(std::log10(std::abs(value))));
}

// Half a unit of the last decimal to which each value is known, ascending as the values. Zeros
// at the end may be left out, and six significant digits leave fewer decimals to greater
// values: a value is known to the decimals of any that are as great or greater.
std::vector<double> rounding_of(const Reading& reading, const std::vector<double>& values) {
  std::map<int, std::size_t> decimals;  // by position of the first digit
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::size_t& most = decimals[exponent_of(values[i])];
    most = std::max(most, reading.numbers[reading.order[i]].fraction.size());
  }
  std::size_t most = 0;
  for (auto it = decimals.rbegin(); it != decimals.rend(); ++it) {
    most = it->second = std::max(most, it->second);
  }
  std::vector<double> rounding;
  for (const double value : values) {
    rounding.push_back(
        reading.has_fractions
            ? 0.5 * std::pow(10.0, -static_cast<double>(decimals[exponent_of(value)]))
            : 0.0);
  }
  return rounding;
}

// What computing with doubles may add to an error.
double slack_of(const std::vector<double>& values, double step) {
  const double greatest = std::max(std::abs(values.front()), std::abs(values.back()));
  return 1e-9 * step + 4.0 * std::numeric_limits<double>::epsilon() * greatest;
}

bool are_on_a_line(const std::vector<double>& values, const std::vector<double>& rounding) {
  const double step = (values.back() - values.front()) / static_cast<double>(values.size() - 1);
  const double ends = std::max(rounding.front(), rounding.back());
  for (std::size_t i = 1; i + 1 < values.size(); ++i) {
    const double expected = values.front() + step * static_cast<double>(i);
    const double error = std::abs(values[i] - expected);
    if (!(error <= rounding[i] + ends + slack_of(values, step))) return false;
  }
  return true;
}

// Differences beyond the smallest one.
std::vector<std::size_t> gaps_of(const std::vector<double>& values, double step) {
  std::vector<std::size_t> gaps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] - values[i - 1] > 1.1 * step) gaps.push_back(i - 1);
  }
  return gaps;
}

// Whether no more multiples of the smallest step are missing than half of those there.
bool are_dense(const std::vector<double>& values, double step) {
  const double places = (values.back() - values.front()) / step + 1.0;
  const auto count = static_cast<double>(values.size());
  return 2.0 * (places - count) <= count + 1e-6;
}

// Frames that are missing leave few differences greater than a step of one unit of the last
// decimal; rounding leaves many.
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
    steps.gaps.clear();
  }
  for (std::size_t i = 1; i < values.size(); ++i) {
    steps.crosses_whole_frame |= std::floor(values[i]) != std::floor(values[i - 1]) &&
                                 values[i] - values[i - 1] <= 1.1 * steps.step;
  }
  if (!steps.gaps.empty()) {
    steps.regularity = 2 * steps.gaps.size() < values.size() - 1 || are_dense(values, smallest)
                           ? Regularity::kFewGaps
                           : Regularity::kIrregular;
  }
  return steps;
}

}  // namespace rlpc
