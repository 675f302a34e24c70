// Tests names with times, versions and counters: each scheme is read in its order, or refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "encoder/meshes/names/frame_names.h"
#include "encoder/meshes/names/frame_pattern.h"
#include "encoder/testing/random_names.h"

namespace rlpc {
namespace {

template <class T>
const T& any(Random& random, const std::vector<T>& values) {
  return values[below(random, values.size())];
}

Names shuffled(Names names, Random& random) {
  std::shuffle(names.begin(), names.end(), random);
  return names;
}

std::string message_of(const Names& names) {
  const auto files = sort_frames(names, "FOLDER");
  return files ? "" : files.error().message;
}

void expect_order_without_notes(const Names& names) {
  Random random(7);
  for (int i = 0; i < 3; ++i) {
    const auto files = sort_frames(shuffled(names, random), "FOLDER");
    ASSERT_TRUE(files) << files.error().message;
    EXPECT_EQ(files->paths, names);
    EXPECT_TRUE(files->notes.empty()) << files->notes[0];
  }
}

// Returns the patterns of an error about several orders; empty: it is another error.
Names patterns_in(const std::string& message) {
  static const std::string kFirst = "choose with a pattern: ";
  static const std::string kNext = ", or ";
  Names patterns;
  std::size_t place = message.find(kFirst);
  if (place == message.npos) return {};
  for (std::size_t length = kFirst.size(); place != message.npos; length = kNext.size()) {
    const std::size_t first = place + length;
    patterns.push_back(message.substr(first, message.find(" for ", first) - first));
    place = message.find(kNext, first);
  }
  return patterns;
}

Names selected(const std::string& pattern, const Names& names) {
  const auto files = select_frames(pattern, names);
  return files ? files->paths : Names{files.error().message};
}

// Expects that names are refused, with a pattern for either order.
void expect_two_orders(const Names& names, const Names& others) {
  const std::string message = message_of(names);
  const Names patterns = patterns_in(message);
  ASSERT_EQ(patterns.size(), 2U) << message;
  const std::set<Names> orders{selected(patterns[0], names), selected(patterns[1], names)};
  EXPECT_EQ(orders, (std::set<Names>{names, others})) << message;
  EXPECT_NE(message.find(names[0] + ", " + names[1]), message.npos) << message;
  EXPECT_NE(message.find(others[0] + ", " + others[1]), message.npos) << message;
}

TEST(NameOrder, FollowsTimes) {
  expect_order_without_notes({"t=0.0.obj", "t=0.041667.obj", "t=0.083333.obj", "t=0.125.obj",
                              "t=0.166667.obj", "t=0.208333.obj", "t=0.25.obj",
                              "t=0.291667.obj"});
  expect_order_without_notes({"f1.0.obj", "f1.033333.obj", "f1.066667.obj", "f1.1.obj",
                              "f1.133333.obj", "f1.166667.obj", "f1.2.obj"});
  expect_order_without_notes(
      {"v2_0.0.obj", "v2_0.02.obj", "v2_0.04.obj", "v2_0.06.obj", "v2_0.08.obj", "v2_0.1.obj"});
  expect_order_without_notes(
      {"f_0.obj", "f_0.02.obj", "f_0.04.obj", "f_0.06.obj", "f_0.08.obj", "f_0.1.obj"});
  expect_order_without_notes({"f1.00.obj", "f1.12.obj", "f1.25.obj", "f1.38.obj", "f1.50.obj",
                              "f1.62.obj", "f1.75.obj", "f1.88.obj", "f2.00.obj"});
  expect_order_without_notes({"f_0.95.obj", "f_1.0.obj", "f_1.05.obj", "f_1.1.obj"});
  expect_order_without_notes(
      {"f_9.9583.obj", "f_10.obj", "f_10.0417.obj", "f_10.0833.obj", "f_10.125.obj"});
  expect_order_without_notes({"f_-0.50.obj", "f_-0.25.obj", "f_0.00.obj"});
  expect_order_without_notes({"f_-0.75.obj", "f_-0.50.obj", "f_-0.25.obj"});
  expect_order_without_notes({"f+1.5.obj", "f+2.0.obj", "f+2.5.obj"});
  expect_order_without_notes({"f-0.5.obj", "f+0.0.obj", "f+0.5.obj"});
}

TEST(NameOrder, FollowsTimesAfterHyphensAndTells) {
  const auto files = sort_frames({"s-0.08.obj", "s-0.00.obj", "s-0.04.obj"}, "FOLDER");
  ASSERT_TRUE(files);
  EXPECT_EQ(files->paths, (Names{"s-0.00.obj", "s-0.04.obj", "s-0.08.obj"}));
  EXPECT_EQ(files->notes, Names{"the hyphens before the numbers are read as separators; "
                                "s%g.obj reads them as signs"});
}

TEST(NameOrder, FollowsTimesWithFramesMissing) {
  const auto order = [](const Names& names) {
    const auto files = sort_frames(names, "FOLDER");
    return files ? files->paths : Names{files.error().message};
  };
  for (const Names& names :
       {Names{"f_-1.5.obj", "f_-1.obj", "f_-0.5.obj", "f_-0.25.obj"},
        Names{"t=0.000.obj", "t=0.100.obj", "t=0.350.obj", "t=0.800.obj", "t=1.250.obj"},
        Names{"f_1.0.obj", "f_1.5.obj", "f_2.0.obj", "f_2.5.obj", "f_10.0.obj", "f_10.5.obj"},
        Names{"v003.8.obj", "v003.9.obj", "v003.11.obj", "v003.12.obj"}}) {
    EXPECT_EQ(order(names), names);
    EXPECT_EQ(sort_frames(names, "FOLDER")->notes.size(), 1U);
  }
}

TEST(NameOrder, IsRefusedWhereTwoCanBeMeant) {
  expect_two_orders({"f_1.25.obj", "f_1.5.obj"}, {"f_1.5.obj", "f_1.25.obj"});
  expect_two_orders({"f-3.00.obj", "f-2.80.obj", "f-2.60.obj"},
                    {"f-2.60.obj", "f-2.80.obj", "f-3.00.obj"});
  expect_two_orders({"t1.0.obj", "t1.2.obj", "t1.3.obj", "t1.4.obj", "t1.11.obj"},
                    {"t1.0.obj", "t1.11.obj", "t1.2.obj", "t1.3.obj", "t1.4.obj"});
  expect_two_orders({"t1.8.obj", "t1.9.obj", "t1.11.obj", "t1.12.obj"},
                    {"t1.11.obj", "t1.12.obj", "t1.8.obj", "t1.9.obj"});
  expect_two_orders({"t1.05.obj", "t1.1.obj", "t1.33.obj", "t1.9.obj"},
                    {"t1.1.obj", "t1.05.obj", "t1.9.obj", "t1.33.obj"});
}

TEST(NameOrder, IsRefusedForFractionsWithoutPoint) {
  for (const Names& names :
       {Names{"t_0_0.obj", "t_0_041667.obj", "t_0_083333.obj", "t_0_125.obj", "t_0_166667.obj"},
        Names{"t0p25.obj", "t0p5.obj", "t0p75.obj"},
        Names{"t0-05.obj", "t0-1.obj", "t0-33.obj"}}) {
    const std::string message = message_of(names);
    EXPECT_NE(message.find("as fractions, " + names[0] + ", " + names[1]), message.npos)
        << message;
  }
  expect_order_without_notes({"t_1_8.obj", "t_1_9.obj", "t_1_10.obj", "t_1_11.obj"});
  expect_order_without_notes({"v2_08.obj", "v2_09.obj", "v2_10.obj", "v2_11.obj"});
  expect_two_orders({"f_1e-03.obj", "f_1e-02.obj", "f_1e-01.obj"},
                    {"f_1e-01.obj", "f_1e-02.obj", "f_1e-03.obj"});
}

TEST(NameOrder, IsNotThatOfTakesAndRestPoses) {
  for (const Names& names :
       {Names{"take1.0.obj", "take1.1.obj", "take1.2.obj", "take2.0.obj", "take2.1.obj"},
        Names{"take1.obj", "take1.0001.obj", "take1.0002.obj", "take2.obj", "take2.0001.obj"},
        Names{"take1.0050.obj", "take1.0100.obj", "take2.0050.obj", "take2.0100.obj"},
        Names{"take1.obj", "take1.0001.obj", "take1.0002.obj", "take1.0004.obj"}}) {
    EXPECT_NE(message_of(names).find("take%g.obj for all, as numbers"), std::string::npos)
        << message_of(names);
  }
}

// Prints numbers as various programs do.
class Printer {
 public:
  explicit Printer(Random& random)
      : style_(static_cast<Style>(below(random, 4))),
        format_(any<const char*>(random, {"%.1f", "%.2f", "%.3f", "%.4f", "%.6f", "%06.3f",
                                          "%07.2f", "%+.2f", "%+.3f"})) {}

  std::string print(double value) const {
    switch (style_) {
      case Style::kSixDigits:
        return with("%g", value);
      case Style::kFixed:
        return with(format_, value);
      case Style::kRounded:
        return shortest(std::round(value * 1e6) / 1e6);
      default:
        return shortest(value);
    }
  }

 private:
  enum class Style : std::uint8_t { kSixDigits, kFixed, kRounded, kShortest };

  static std::string with(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
  }
  // Prints as Python does.
  static std::string shortest(double value) {
    char text[64];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    std::string number(text, end);
    return number.find_first_of(".e") == number.npos ? number + ".0" : number;
  }

  Style style_;
  const char* format_;
};

// Returns a sequence whose names have the times of its frames; empty: they are not all
// different, or have exponents.
Names random_times(Random& random) {
  const Printer printer(random);
  const std::string before = any<std::string>(
      random, {"", "f", "f_", "t=", "walk.", "sim-", "x_t", "v2_", "frame ", "sh010_v003_",
               "cap_2026-01-31_", "walk (", "\xC3\xA9_", "take2_"});
  const std::string after =
      any<std::string>(random, {".obj", "_mesh.obj", ".geo.obj", "s.OBJ"});
  const double rate =
      any<double>(random, {24, 25,   30,  48,  50,   60,   120, 23.976, 29.97,   20,      8,
                           4,  10.0, 5.0, 2.0, 100., 1000, 12., 3.0,    1 / .75, 1 / 1.5, 0.4});
  double first = 0.0;
  switch (below(random, 4)) {
    case 0:
      first = static_cast<double>(below(random, 21));
      break;
    case 1:
      first = static_cast<double>(below(random, 500)) / rate;
      break;
    case 2:
      first = -static_cast<double>(below(random, 12)) / (below(random, 2) == 0 ? rate : 2.0);
      break;
    default:
      break;
  }
  const std::size_t count = 3 + below(random, 38);
  const bool is_added_up = below(random, 4) == 0;  // t += 1 / rate
  Names names;
  std::set<double> values;
  double time = first;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number = printer.print(time);
    if (number.find('e') != number.npos) return {};
    values.insert(std::stod(number));
    names.push_back(before + number + after);
    time = is_added_up ? time + 1.0 / rate : first + static_cast<double>(i + 1) / rate;
  }
  return values.size() == count ? names : Names{};
}

// Returns the frames of a version or take, some perhaps missing.
Names random_counters(Random& random) {
  const std::string before =
      any<std::string>(random, {"v2.", "sh010_v003.", "take1.", "shot_12.", "f.1001.",
                                "walk-2.", "a1,", "sim_0.", "take2.", "mesh.v3."});
  const std::string after = any<std::string>(random, {".obj", ".mesh01.obj", "_lod2.obj"});
  const int width = static_cast<int>(below(random, 6));
  const std::size_t step = any<std::size_t>(random, {1, 1, 1, 1, 2, 5, 10});
  const std::size_t missing = any<std::size_t>(random, {0, 0, 0, 7});
  std::size_t number = any<std::size_t>(random, {0, 1, 8, 95, 990, 1001});
  Names names;
  for (std::size_t i = 3 + below(random, 38); i > 0; --i, number += step) {
    if (missing > 0 && below(random, missing) == 0) continue;
    char digits[32];
    std::snprintf(digits, sizeof digits, "%0*d", width, static_cast<int>(number));
    names.push_back(before + digits + after);
  }
  return names.size() < 3 ? Names{} : names;
}

// Fails if an order is wrong, or none is found in 5 % of the sequences or more.
void expect_right_or_refused(Names (*random_names)(Random&), std::uint32_t seed) {
  Random random(seed);
  int refused = 0;
  int tried = 0;
  for (int i = 0; i < 10000; ++i) {
    const Names names = random_names(random);
    if (names.empty()) continue;
    ++tried;
    const Names given = shuffled(names, random);
    const auto files = sort_frames(given, "FOLDER");
    // Times up to -0.0 may be in the opposite order, which a note reports.
    const bool is_told = files && !files->notes.empty() &&
                         files->notes.back().find("read as separators") != std::string::npos;
    if (is_told && files->paths != names) {
      ASSERT_EQ(Names(files->paths.rbegin(), files->paths.rend()), names);
    } else if (files) {
      ASSERT_EQ(files->paths, names) << "seed " << seed << ", sequence " << i;
    }
    if (files) continue;
    ++refused;
    const std::string& message = files.error().message;
    bool is_advised = message.find("for all, as numbers") != message.npos;
    for (const std::string& pattern : patterns_in(message)) {
      is_advised |= selected(pattern, given) == names;
    }
    EXPECT_TRUE(is_advised) << message << testing::PrintToString(names);
  }
  testing::Test::RecordProperty("tried", tried);
  testing::Test::RecordProperty("refused", refused);
  EXPECT_GT(tried, 5000);
  EXPECT_LT(100 * refused, 5 * tried) << refused << " of " << tried;
}

TEST(NameOrder, IsRightOrRefusedForRandomTimes) { expect_right_or_refused(random_times, 21); }

TEST(NameOrder, IsRightOrRefusedForRandomCounters) {
  expect_right_or_refused(random_counters, 22);
}

}  // namespace
}  // namespace rlpc
