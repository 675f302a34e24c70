#include "encoder/meshes/names/name_order.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "encoder/meshes/names/frame_steps.h"

namespace rlpc {

namespace {

// [whole part]: the fractions of names with it, as counters.
using Counters = std::map<std::string_view, std::vector<double>>;

Counters counters_of(const Reading& reading) {
  Counters counters;
  for (const NameNumber& n : reading.numbers) {
    if (n.fraction.empty()) continue;
    counters[n.significant()].push_back(NameNumber{.whole = n.fraction}.value());
  }
  for (auto& [whole, values] : counters) std::sort(values.begin(), values.end());
  return counters;
}

// Whether all names have a fraction, of one length, of two digits or more.
bool are_fractions_fixed(const std::vector<NameNumber>& numbers) {
  constexpr std::size_t kMinDigits = 2;
  const std::size_t length = numbers.front().fraction.size();
  return length >= kMinDigits &&
         std::all_of(numbers.begin(), numbers.end(),
                     [&](const NameNumber& n) { return n.fraction.size() == length; });
}

// Whether the names may be the frames of several takes or versions, as in take1.0001: in each,
// the number after the point counts with few gaps.
bool may_be_takes(const Reading& reading) {
  std::vector<double> differences;
  for (const auto& [whole, values] : counters_of(reading)) {
    for (std::size_t i = 1; i < values.size(); ++i) {
      differences.push_back(values[i] - values[i - 1]);
    }
  }
  if (differences.empty()) return false;
  const double step = *std::min_element(differences.begin(), differences.end());
  const auto steps = std::count(differences.begin(), differences.end(), step);
  return 2 * steps >= static_cast<std::ptrdiff_t>(differences.size()) &&
         (step == 1.0 || are_fractions_fixed(reading.numbers));
}

// Whether one name may be a rest pose, as take1 before take1.0001: only it has no fraction, and
// the fractions of the others have zeros before them. Times that begin at 0 have none.
bool may_have_rest_pose(const Reading& reading) {
  const std::string_view whole = reading.numbers.front().significant();
  std::size_t length = 0;
  std::ptrdiff_t without = 0;
  for (const NameNumber& n : reading.numbers) {
    if (n.significant() != whole || whole.empty()) return false;
    if (n.fraction.empty()) {
      ++without;
      continue;
    }
    if (length == 0) length = n.fraction.size();
    if (n.fraction.front() != '0' || n.fraction.size() != length || length < 2) return false;
  }
  return without == 1;
}

// Whether each frame that has parts is present itself, except perhaps the first.
bool has_whole_frames(const FrameSteps& steps) {
  const double first = std::floor(steps.values.front());
  return std::all_of(steps.values.begin(), steps.values.end(), [&](double value) {
    const double frame = std::floor(value);
    return frame == first ||
           std::binary_search(steps.values.begin(), steps.values.end(), frame);
  });
}

bool is_one_whole(const Reading& reading) {
  return std::all_of(reading.numbers.begin(), reading.numbers.end(), [&](const NameNumber& n) {
    return n.significant() == reading.numbers.front().significant();
  });
}

// Whether numbers with fractions, which no counter explains, are one sequence.
bool is_one_sequence(const Reading& reading) {
  if (!can_be_written(reading) || may_have_rest_pose(reading)) return false;
  if (follows_version(reading) && !is_one_whole(reading)) return false;
  const FrameSteps steps = steps_of(reading);
  if (steps.regularity == Regularity::kEqualSteps) return true;
  const bool are_takes = may_be_takes(reading) && !steps.crosses_whole_frame;
  if (are_takes) return false;
  if (are_fractions_fixed(reading.numbers)) return true;
  return steps.regularity == Regularity::kFewGaps &&
         (steps.crosses_whole_frame || has_whole_frames(steps));
}

bool have_one_order(const std::vector<Reading>& readings) {
  return std::all_of(readings.begin(), readings.end(), [&](const Reading& reading) {
    return reading.order == readings.front().order;
  });
}

std::vector<Reading> only_written(const std::vector<Reading>& readings) {
  std::vector<Reading> left;
  std::copy_if(readings.begin(), readings.end(), std::back_inserter(left), can_be_written);
  return left;
}

// Returns the most regular of at least one reading with the same order, for notes about gaps.
const Reading& simplest(const std::vector<Reading>& readings) {
  const auto regularity = [](const Reading& reading) {
    const FrameSteps steps = steps_of(reading);
    const int notes = reading.has_fractions ? 1 : steps.step > 1.1 ? 2 : 0;
    return std::pair(steps.regularity, notes);
  };
  return *std::min_element(
      readings.begin(), readings.end(),
      [&](const Reading& a, const Reading& b) { return regularity(a) < regularity(b); });
}

// Returns the readings that have equal steps; with two names, all have. Rounded fractions must
// compete with no counter that has few gaps: 0.11, 0.2, 0.3 may be rounded, or 2, 3, 11.
std::vector<Reading> only_regular(const std::vector<Reading>& readings) {
  std::vector<Reading> left;
  bool has_counter = false;
  bool is_rounded = true;
  for (const Reading& reading : readings) {
    const FrameSteps steps = steps_of(reading);
    has_counter |= !reading.has_fractions && steps.regularity != Regularity::kIrregular;
    if (steps.regularity != Regularity::kEqualSteps) continue;
    left.push_back(reading);
    is_rounded = is_rounded && steps.is_rounded;
  }
  return has_counter && is_rounded ? std::vector<Reading>{} : left;
}

// Returns the counter after a version, if it has few gaps and the fractions are irregular.
std::vector<Reading> only_counted_version(const std::vector<Reading>& readings) {
  bool has_version = false;
  std::vector<Reading> left;
  for (const Reading& reading : readings) {
    const Regularity regularity = steps_of(reading).regularity;
    if (!reading.has_fractions) {
      if (regularity != Regularity::kIrregular) left.push_back(reading);
    } else if (regularity != Regularity::kIrregular) {
      return {};
    }
    has_version |= reading.has_fractions && follows_version(reading);
  }
  return has_version ? left : std::vector<Reading>{};
}

// Returns one reading for each order.
std::vector<Reading> rivals_of(const std::vector<Reading>& readings) {
  std::vector<Reading> rivals;
  for (const Reading& reading : readings) {
    const bool is_new = std::all_of(rivals.begin(), rivals.end(), [&](const Reading& rival) {
      return rival.order != reading.order;
    });
    if (is_new) rivals.push_back(reading);
  }
  return rivals;
}

// Reads whole numbers as fractions, if that is likely enough: t_0_25, t_0_5, t_0_75 count in no
// steps, and the zeros of t_0_041667 and t_0_125 pad to no width.
std::optional<Reading> likely_fractions(const Reading& counted) {
  auto fractions = read_as_fractions(counted);
  if (!fractions || fractions->has_twice || fractions->order == counted.order ||
      !can_be_written(*fractions)) {
    return std::nullopt;
  }
  if (!are_padded_alike(counted)) return fractions;
  const bool are_steps_equal = steps_of(*fractions).regularity == Regularity::kEqualSteps;
  const bool is_likely =
      are_steps_equal && steps_of(counted).regularity != Regularity::kEqualSteps;
  return is_likely ? std::move(fractions) : std::nullopt;
}

// Decides between readings of which each gives every name a number of its own.
void decide(const std::vector<Reading>& readings, NameOrder& order) {
  std::vector<Reading> likely = readings;
  if (!have_one_order(likely)) likely = only_written(readings);
  if (likely.empty()) {
    order.rivals = rivals_of(readings);
    return;
  }
  if (!have_one_order(likely)) {
    const std::vector<Reading> written = std::move(likely);
    likely = only_regular(written);
    if (likely.empty()) likely = only_counted_version(written);
    if (likely.empty() || !have_one_order(likely)) {
      order.rivals = rivals_of(written);
      return;
    }
  }
  const Reading& best = simplest(likely);
  const bool is_counted = std::any_of(likely.begin(), likely.end(), [](const Reading& reading) {
    return !reading.has_fractions;
  });
  if (is_counted || is_one_sequence(best)) {
    order.chosen = best;
    order.pointless = likely_fractions(best);
  } else if (!have_one_order(readings)) {
    order.rivals = rivals_of(readings);
  } else {
    order.doubtful = best;
  }
}

}  // namespace

NameOrder find_order(const std::vector<std::string>& names) {
  std::vector<Reading> readings;
  NameOrder order;
  for (const NameForm& form : forms_of(names.front())) {
    auto reading = read_numbers(form, names);
    if (!reading) continue;
    const Signs signs = signs_of(*reading);
    if (signs == Signs::kNone) continue;
    if (reading->has_twice) {
      if (!order.twice) order.twice = std::move(reading);
    } else if (signs == Signs::kUnlikely) {
      order.unlikely = std::move(reading);
    } else {
      readings.push_back(std::move(*reading));
    }
  }
  if (!readings.empty()) decide(readings, order);
  return order;
}

}  // namespace rlpc
